/PROG  POCKET
/ATTR
COMMENT		= "";
LINE_COUNT	= 9;
DEFAULT_GROUP	= 1,*,*,*,*;
/MN
   1:  !POCKET ;
   2:  UFRAME_NUM=1 ;
   3:  UTOOL_NUM=2 ;
   4:J P[1] 50% FINE    ;
   5:L P[2:DOWN] 20mm/sec CNT100    ;
   6:L P[3] 240cm/min CNT60 ACC80    ;
   7:C P[4]    
    :  P[5] 20mm/sec CNT50    ;
   8:L P[2] 20mm/sec CNT100    ;
   9:J P[6] 50% FINE    ;
/POS
P[1]{
   GP1:
	UF : 1, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =     0.000  mm,	Z =    50.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[2:"DOWN"]{
   GP1:
	UF : 1, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =     0.000  mm,	Z =     0.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[3]{
   GP1:
	UF : 1, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =    60.000  mm,	Y =     0.000  mm,	Z =     0.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    10.000 deg
};
P[4]{
   GP1:
	UF : 1, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =    70.000  mm,	Y =    10.000  mm,	Z =     0.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    10.000 deg
};
P[5]{
   GP1:
	UF : 1, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =    60.000  mm,	Y =    20.000  mm,	Z =     0.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    10.000 deg
};
P[6]{
   GP1:
	UF : F, UT : F,
	J1=     0.000 deg,	J2=     0.000 deg,	J3=     0.000 deg,
	J4=     0.000 deg,	J5=   -90.000 deg,	J6=     0.000 deg
};
/END
