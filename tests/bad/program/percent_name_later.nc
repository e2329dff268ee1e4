(expect: 4:1: error: a '%' stands alone on its line)
O1
G21 G90
%PART
M30
