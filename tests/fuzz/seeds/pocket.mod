%%%
  VERSION:1
%%%
MODULE Pocket(SYSMODULE)
  PERS tooldata spindle:=[TRUE,[[0,0,200],[1,0,0,0]],[5,[0,0,1],[1,0,0,0],0,0,0]];
  TASK PERS wobjdata table := [FALSE,TRUE,"",[[100,0,0],[0.7071068,0,0,0.7071068]],[[0,5,0],[1,0,0,0]]];
  VAR speeddata slow:=[12.5,500,5000,1000];
  CONST zonedata near:=[FALSE,2,3,3,.3,3,.3];
  CONST robtarget p1:=[[10,20,30],[0,0.6,0.8,0],[-1,0,1,4],[850,9E9,9E9,9E9,9E9,9E9]];
  VAR robtarget p2:=[[1, ! x
    2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
PROC main()
  ! LEVEL 1
  ConfL\Off;
  MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs, v100, z5, tool0;
  MoveJ p1, v1000, z10, spindle\WObj:=table;
  MoveL Offs(p1,0,0,-31.5),v100\V:=20,z1,spindle\WObj:=table; ! down
  MoveL RelTool(p1,1,2,3),slow,near,spindle\WObj:=table;
  MoveC [[12,22,-1.5],[0,0.6,0.8,0],[-1,0,1,4],[850,9E9,9E9,9E9,9E9,9E9]],p1,v50,z1\Inpos:=inpos50,spindle\WObj:=table;
  IF di1 = 1 AND n > 2 MoveL p2,v100,fine,tool0;
  FOR i FROM 1 TO 3 DO MoveL p2,v100\T:=2,fine,tool0; ENDFOR
  TEST n CASE 1,2: Stop; DEFAULT: x{2}:=p2.trans.x; ENDTEST
  again:
  MoveL\Conc,ToPoint:=[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],[10,1,1,1],[TRUE,0,0,0,0,0,0],tool0;
  CirPathMode\ObjectFrame;
ERROR
  RETRY;
ENDPROC
FUNC num half(num x) RETURN x/2; ENDFUNC
ENDMODULE
