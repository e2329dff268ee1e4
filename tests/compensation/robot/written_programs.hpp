#pragma once
/// A small program of every language of six-axis machines: lines with room for inserted points, a target that
/// two moves share, and what the language keeps besides coordinates.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "compensation/support/arm.hpp"

namespace counterflex::test {

/// A program for the arm of the tests, and how this test finds the numbers of targets in its text.
struct WrittenProgram {
  std::string dialect, text;
  /// Of one target: three groups for the position, then three or four for the orientation.
  std::string target;
  double mm_of_length = 1;  ///< length of the unit of positions
  bool in_radians = false;  ///< angles of the orientation
  bool is_quaternion = false;
};

inline std::string krl_text() {
  return "&ACCESS RVO\n"
         "DEF part( )\n"
         "INT n\n"
         "$BASE={X 1700.0,Y 0.0,Z 600.0,A 0.0,B 0.0,C 0.0}\n"
         "$TOOL=TOOL_DATA[3]\n"
         "PTP {X 30.0,Y 40.0,Z 40.0,A 10.0,B 3.0,C 8.0,S 2,E1 0.0}\n"
         "$VEL.CP=0.025\n"
         "LIN {X 30.0,Y 40.0,Z 0.0,A 10.0,B 3.0,C 8.0,E1 0.0} C_DIS ;down\n"
         "LIN {X 150.0,Y 50.0,Z 1.0,A 4.0,B -8.0,C 12.0,E1 0.0} C_DIS\n"
         "LIN XBOTH C_DIS\n"
         "$VEL.CP=0.05\n"
         "FOR n = 1 TO 3\n"
         "  LIN EDGE[n] C_DIS\n"
         "ENDFOR\n"
         "CIRC {X 90.0,Y 90.0,Z 5.0},{X 60.0,Y 60.0,Z 5.0,A 5.0,B 2.0,C 3.0,E1 0.0} C_DIS\n"
         "LIN {X 100.0,Y 120.0,Z 30.0,A 20.0,B 0.0,C 5.0,E1 0.0} C_DIS\n"
         "PTP XBOTH\n"
         "END\n"
         "\n&FILE part.dat\n"
         "DEFDAT part PUBLIC\n"
         "DECL E6POS XBOTH={X 190.0,Y 110.0,Z 0.0,A 40.0,B 10.0,C -10.0,E1 0.0}\n"
         "DECL FRAME EDGE[3]\n"
         "EDGE[1]={X 180.0,Y 100.0,Z 0.0,A 30.0,B 10.0,C -10.0}\n"
         "EDGE[2]={X 60.0,Y 60.0,Z 10.0,A -40.0,B -10.0,C 12.0}\n"
         "EDGE[3]={X 120.0,Y 60.0,Z 5.0,A 5.0,B 2.0,C 3.0}\n"
         "ENDDAT\n";
}

inline std::string rapid_text() {
  const std::string rest = ",[0,0,-1,1],[0,9E9,9E9,9E9,9E9,9E9]]";
  return "MODULE part\n"
         "  PERS wobjdata table:=[FALSE,TRUE,\"\",[[1700,0,600],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n"
         "  CONST robtarget both:=[[190,110,0],[0.933013,-0.066987,0.110000,0.336000]" +
         rest +
         ";\n"
         "  CONST robtarget first:=[[30,40,0],[1,0,0,0]" +
         rest +
         ";\n"
         "PROC main()\n"
         "  ConfJ\\Off;\n"
         "  ConfL\\Off;\n"
         "  MoveJ [[30,40,40],[1,0,0,0]" +
         rest +
         ",v1000,z10,spindle\\WObj:=table;\n"
         "  MoveL first,v25,z5,spindle\\WObj:=table;\n"
         "  MoveL [[150,50,1],[0.992404,0.104528,-0.069756,0.005]" +
         rest +
         ",v25,z5,spindle\\WObj:=table; ! cut\n"
         "  MoveL both,v25,z5,spindle\\WObj:=table;\n"
         "  MoveL [[60,60,10],[0.984808,0.03,0.02,-0.173648]" +
         rest +
         ",v50,z5,spindle\\WObj:=table;\n"
         "  MoveC [[90,90,5],[0.984808,0.03,0.02,-0.173648]" +
         rest + ",[[120,60,5],[0.984808,0.03,0.02,-0.173648]" + rest +
         ",v50,z5,spindle\\WObj:=table;\n"
         "  MoveJ both,v1000,fine,spindle\\WObj:=table;\n"
         "ENDPROC\n"
         "ENDMODULE\n";
}

inline std::string ur_text() {
  return "def part():\n"
         "  table = p[1.7, 0.0, 0.6, 0.0, 0.0, 0.0]\n"
         "  both = p[1.890, 0.110, 0.600, -0.17, 0.19, 0.66]\n"
         "  movej(p[1.730, 0.040, 0.640, 0.0, 0.0, 0.0], a=1.0, v=0.3)\n"
         "  movel(p[1.730, 0.040, 0.600, 0.0, 0.0, 0.0], a=1.0, v=0.025, r=0.005)\n"
         "  movel(pose_trans(table, p[0.150, 0.050, 0.001, 0.21, -0.14, 0.01]), a=1.0, v=0.025, r=0.005) # "
         "cut\n"
         "  movel(both, a=1.0, v=0.025, r=0.005)\n"
         "  movel(p[1.760, 0.060, 0.610, 0.06, 0.04, -0.35], a=1.0, v=0.05, r=0.005)\n"
         "  movec(p[1.790, 0.090, 0.605, 0.0, 0.0, 0.0], p[1.820, 0.060, 0.605, 0.06, 0.04, 0.04], a=1.0, "
         "v=0.05, "
         "r=0.005)\n"
         "  movej(both, a=1.0, v=0.3)\n"
         "end\n";
}

inline std::string tp_text() {
  const auto position = [](const std::string& name, const Vector3& p, const Vector3& wpr) {
    return fmt::format(
        "P[{}]{{\n   GP1:\n\tUF : 1, UT : 2,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {:9.3f}  mm,\tY = {:9.3f}  "
        "mm,"
        "\tZ = {:9.3f}  mm,\n\tW = {:9.3f} deg,\tP = {:9.3f} deg,\tR = {:9.3f} deg,\n\tE1=     0.000  "
        "mm\n}};\n",
        name, p.x(), p.y(), p.z(), wpr.x(), wpr.y(), wpr.z());
  };
  return "/PROG  PART\n/ATTR\nLINE_COUNT\t= 10;\nDEFAULT_GROUP\t= 1,*,*,*,*;\n/MN\n"
         "   1:  UFRAME_NUM=1 ;\n"
         "   2:  UTOOL_NUM=2 ;\n"
         "   3:J P[1] 50% FINE    ;\n"
         "   4:L P[2:DOWN] 25mm/sec CNT100    ;\n"
         "   5:L P[3] 25mm/sec CNT100 ACC80    ;\n"
         "   6:L P[4] 25mm/sec CNT100    ;\n"
         "   7:L P[5] 50mm/sec CNT100    ;\n"
         "   8:C P[6]\n    :  P[7] 50mm/sec CNT50    ;\n"
         "   9:L P[8] 50mm/sec CNT100    ;\n"
         "  10:J P[4] 50% FINE    ;\n/POS\n" +
         position("1", {30, 40, 40}, {0, 0, 0}) + position("2:\"DOWN\"", {30, 40, 0}, {0, 0, 0}) +
         position("3", {150, 50, 1}, {12, -8, 4}) + position("4", {190, 110, 0}, {-10, 10, 40}) +
         position("5", {60, 60, 10}, {3, 2, -20}) + position("6", {90, 90, 5}, {3, 2, -20}) +
         position("7", {120, 60, 5}, {3, 2, -20}) + position("8", {100, 120, 30}, {5, 0, 20}) + "/END\n";
}

inline std::string jbi_text() {
  return "/JOB\n//NAME PART\n//POS\n///NPOS 8,8,0,1,0,0\n///USER 1\n///TOOL 2\n///POSTYPE USER\n///RECTAN\n"
         "///RCONF 1,0,0,0,0,0,0,0\n"
         "C00000=30.000,40.000,40.000,0.0000,0.0000,0.0000\n"
         "C00001=30.000,40.000,0.000,0.0000,0.0000,0.0000\n"
         "C00002=150.000,50.000,1.000,12.0000,-8.0000,4.0000\n"
         "C00003=60.000,60.000,10.000,3.0000,2.0000,-20.0000\n"
         "C00004=60.000,60.000,10.000,3.0000,2.0000,-20.0000\n"
         "C00005=90.000,90.000,5.000,3.0000,2.0000,-20.0000\n"
         "C00006=120.000,60.000,5.000,3.0000,2.0000,-20.0000\n"
         "C00007=100.000,120.000,30.000,5.0000,0.0000,20.0000\n"
         "///POSTYPE PULSE\n///PULSE\n"
         "BC00000=0\nBC00001=0\nBC00002=0\nBC00003=0\nBC00004=0\nBC00005=0\nBC00006=0\nBC00007=0\n"
         "///POSTYPE USER\n///RECTAN\n"
         "P00100=190.000,110.000,0.000,-10.0000,10.0000,40.0000\n"
         "//INST\n///DATE 2020/11/19 13:27\n///ATTR SC,RW\n///GROUP1 RB1\nNOP\n"
         "MOVJ C00000 BC00000 VJ=25.00\n"
         "MOVL C00001 BC00001 V=25.0\n"
         "MOVL C00002 BC00002 V=25.0\n"
         "MOVL P00100 V=25.0\n"
         "MOVL C00003 BC00003 V=50.0 CR=2.0\n"
         "MOVC C00004 BC00004 V=50.0\n"
         "MOVC C00005 BC00005 V=50.0\n"
         "MOVC C00006 BC00006 V=50.0 FPT\n"
         "MOVL C00007 BC00007 V=50.0\n"
         "MOVJ P00100 VJ=25.00\nEND\n";
}

inline std::string apt_text() {
  return "PARTNO PART\nUNITS/MM\nLOADTL/5\nSPINDL/2000,RPM,CLW\n"
         "RAPID\n"
         "GOTO/30.0,40.0,40.0,0.0000000,0.0000000,1.0000000\n"
         "FEDRAT/1500.0,MMPM\n"
         "GOTO/30.0,40.0,0.0,0.0000000,0.0000000,1.0000000\n"
         "GOTO/150.0,50.0,1.0,0.2000000,0.1000000,0.9746794\n"
         "GOTO/190.0,110.0,0.0,-0.1500000,0.1800000,0.9721626\n"
         "FEDRAT/3000.0,MMPM\n"
         "GOTO/60.0,60.0,10.0,0.0500000,-0.1000000,0.9937303\n"
         "GOTO/120.0,60.0,5.0\n"
         "RAPID\n"
         "GOTO/190.0,110.0,30.0,0.0000000,0.0000000,1.0000000\nFINI\n";
}

inline std::string ngc_text() {
  return "G21 G90 G17 G94 G54\n"
         "T3 M6\nS9000 M3\n"
         "G0 X30.000 Y40.000 Z40.000 A0.000 B0.000 C0.000\n"
         "G1 Z0.000 F1500\n"
         "N30 X150.000 Y50.000 Z1.000 A12.000 B-8.000 C4.000\n"
         "N40 X190.000 Y110.000 Z0.000 A-10.000 B10.000 C40.000\n"
         "X60.000 Y60.000 Z10.000 A3.000 B2.000 C-20.000 F3000\n"
         "G2 X120.000 Y60.000 I30.000 J0.000\n"
         "G1 X100.000 Y120.000 Z30.000 A5.000 B0.000 C20.000\n"
         "G0 X190.000 Y110.000 Z30.000\nM5\nM30\n";
}

inline std::vector<WrittenProgram> written_programs() {
  const std::string n = "([-+]?[0-9.]+)", c = ", *" + n, b = " *= *" + n + " *";
  return {
      {"kuka", krl_text(), "X " + n + ",Y " + n + ",Z " + n + ",A " + n + ",B " + n + ",C " + n},
      {.dialect = "abb",
       .text = rapid_text(),
       .target = "\\[\\[" + n + c + c + "\\],\\[" + n + c + c + c + "\\]",
       .is_quaternion = true},
      {.dialect = "ur",
       .text = ur_text(),
       .target = "p\\[" + n + c + c + c + c + c + "\\]",
       .mm_of_length = 1000,
       .in_radians = true},
      {"fanuc_tp", tp_text(),
       "X" + b + "mm,\\s*Y" + b + "mm,\\s*Z" + b + "mm,\\s*W" + b + "deg,\\s*P" + b + "deg,\\s*R" + b},
      {"yaskawa", jbi_text(), "[CP][0-9]{5}=" + n + c + c + c + c + c},
      {"apt", apt_text(), "GOTO/" + n + c + c + c + c + c},
      {"linuxcnc", ngc_text(), "X" + n + " Y" + n + " Z" + n + " A" + n + " B" + n + " C" + n},
  };
}

}  // namespace counterflex::test
