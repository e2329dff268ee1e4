(expect: 4:1: error: a '%' must be alone in its line)
O1
G21 G90
%PART
M30
