// Corrected robot programs pass their verification in every form in which a language gives a target.
#include <doctest/doctest.h>

#include "compensation/support/arm.hpp"
#include "counterflex/program/kept_words.hpp"
#include "counterflex/program/read_program.hpp"
#include "counterflex/program/rewrite.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// The corrected text; the run must have no failure.
std::string corrected(const std::string& dialect, const std::string& text) {
  Order order{.machine = arm_machine(), .text = text};
  order.force = constant_force((Vector6() << 120, -300, -80, 2, 5, -3).finished());
  order.max_correction = 20e-3;
  order.X_MW = translation({1.7, 0, 0.6});
  order.read.dialect = dialect;
  const Shop shop(order);
  const std::string result = compensated(shop).text;
  const auto failure = verify(shop.job(), read_program(result, "corrected", order.read), false).failure;
  CHECK(!failure);
  CHECK(result != text);
  return result;
}

const std::string krl_head = "DEF part( )\n$VEL.CP=0.025\nPTP {X 30.0,Y 40.0,Z 40.0,A 10.0,B 3.0,C 8.0}\n";

const std::string ur_head =
    "def part():\n  table = p[1.7, 0.0, 0.6, 0.0, 0.0, 0.0]\n"
    "  first = p[0.150, 0.050, 0.001, 0.21, -0.14, 0.01]\n  blend = 0.005\n"
    "  movej(pose_trans(table,p[0.03,0.04,0.04,0,0,0]), a=1.0, v=0.3)\n";

const std::string rapid_rest = "[0.984808,0.03,0.02,-0.173648],[0,0,-1,1],[0,9E9,9E9,9E9,9E9,9E9]]";

}  // namespace

TEST_CASE("components that a KUKA target lacks may be inserted") {
  corrected("kuka", krl_head +
                        "LIN {Z 0.0} C_DIS\nlin {x 150.0,y 50.0} c_dis\n"
                        "LIN {X 190,Y 110,Z 0,A 40} C_DIS\nLIN_REL {Z 5.0} C_DIS\nEND\n");
  const std::string text =
      corrected("kuka", krl_head +
                            "LIN XA C_DIS\nLIN XB C_DIS\nLIN XA C_DIS\nEND\n\n&FILE p.dat\nDEFDAT p\n"
                            "DECL POS XA={X 150,Y 50,Z 0,S 2,T 2}\nDECL FRAME XB={X 190,Y 110,Z 0,A 40}\n"
                            "ENDDAT\n");
  CHECK(text.find("DECL FRAME XB={X 189.") != std::string::npos);
}

TEST_CASE("an axis that a point of APT lacks may be inserted") {
  corrected("apt",
            "PARTNO "
            "PART\nUNITS/MM\nRAPID\nGOTO/30.0,40.0,40.0,0.0,0.0,1.0\nFEDRAT/1500.0,MMPM\nGOTO/30.0,40.0,0.0\n"
            "GOTO/150.0,60.0,5.0\nFINI\n");
}

TEST_CASE("elements of an array that several KUKA statements name are replaced by their numbers") {
  corrected("kuka", krl_head +
                        "LIN P[1] C_DIS\nLIN P[2] C_DIS\nLIN P[1] C_DIS\nPTP P[1]\nEND\n\n&FILE p.dat\n"
                        "DEFDAT p\nDECL FRAME P[2]\nP[1]={X 150,Y 50,Z 0,A 0,B 0,C 0}\n"
                        "P[2]={X 190,Y 110,Z 0,A 40,B 0,C 10}\nENDDAT\n");
}

TEST_CASE("URScript gives targets and radii by place, by name, by keyword, and in frames") {
  corrected("ur", ur_head +
                      "  movel(pose_trans(table,p[0.03,0.04,0,0,0,0]), 1.2, 0.025, 0, 0.003)\n"
                      "  movel(pose_trans(table,first), 1.2, 0.025, 0, blend)\n"
                      "  movep(pose_trans(table,p[0.06,0.06,0.01,0.06,0.04,-0.35]), 1.2, 0.025, 0.004)\n"
                      "  movec(pose_trans(table,p[0.09,0.09,0.005,0,0,0]), "
                      "pose_trans(table,p[0.12,0.06,0.005,0.06,0.04,0.3]), 1.2, 0.025, 0.004, 0)\n"
                      "  movel(pose_trans(table,first), a=1, v=0.025, r=blend)\nend\n");
  corrected("ur",
            ur_head +
                "  movel(pose=pose_trans(table,first), a=1.2, v=0.025, r=blend)\n"
                "  movel(pose=pose_trans(table,p[0.06,0.06,0.01,0.06,0.04,-0.35]), v=0.025, r = 0.003)\n"
                "  movel(pose_trans(table,first), a=1.2, v=0.025, r=blend)\n"
                "  movej(get_inverse_kin(pose_trans(table,first)))\nend\n");
}

TEST_CASE("RAPID gives targets and zones by name and by value, with options between them") {
  const std::string tail = ",spindle\\WObj:=table;\n";
  corrected("abb",
            "MODULE part\n PERS wobjdata table:=[FALSE,TRUE,\"\",[[1700,0,600],[1,0,0,0]],[[0,0,0],[1,0,0,"
            "0]]];\n CONST zonedata near:=[FALSE,2,3,3,.3,3,.3];\n CONST robtarget p1:=[[150,50,1]," +
                rapid_rest + ";\n CONST robtarget p2:=[[60,60,10]," + rapid_rest +
                ";\n CONST robtarget p3:=[[90,90,5]," + rapid_rest + ";\n CONST robtarget p4:=[[120,60,5]," +
                rapid_rest + ";\nPROC main()\n ConfL\\Off;\n MoveJ [[30,40,40]," + rapid_rest + ",v1000,z10" +
                tail + " MoveL p1,v25,near" + tail + " MoveL p2\\ID:=3,v25,near\\Inpos:=inpos50" + tail +
                " MoveL p1,v25,[FALSE,5,7,7,.7,7,.7]" + tail + " MoveL p2,v25,z5" + tail +
                " MoveC p3,p4,v25,z1" + tail + " MoveL p1,v25\\V:=20,z1" + tail + " MoveL\\Conc,p2,v25,z1" +
                tail + " MoveL Offs( p1 ,0,20,-.5),v25,z1" + tail + " MoveL RelTool(p2, 1, 2, 0),v25,z1" +
                tail + " MoveL Offs([[60,60,10]," + rapid_rest + ",5,0,0),v25,z1" + tail +
                "ENDPROC\nENDMODULE\n");
}

TEST_CASE("a chord of an arc has the statement of the arc, besides the auxiliary point") {
  const std::pair<const char*, std::string> programs[] = {
      {"kuka", krl_head + "CIRC {X 90,Y 90,Z 5,E1 1},{X 60,Y 60,Z 5,A 5,B 2,C 3,E1 0} C_DIS\nEND\n"},
      {"ur", ur_head + "  movec(pose_trans(table,p[0.09,0.09,0.005,0,0,0]), pose_trans(table,first), a=1.2, "
                       "v=0.025, r=0.004, mode=0)\nend\n"},
      {"ur", ur_head + "  movec(pose_via=pose_trans(table,p[0.09,0.09,0.005,0,0,0]), "
                       "pose_to=pose_trans(table,first), r=0.004)\nend\n"},
      {"abb", "MODULE part\nPROC main()\n MoveJ [[30,40,40]," + rapid_rest +
                  ",v1000,z10,tool0;\n MoveC [[90,90,5]," + rapid_rest + ",[[60,60,10]," + rapid_rest +
                  ",v25,z1,tool0;\nENDPROC\nENDMODULE\n"}};
  for (const auto& one : programs) {
    const std::string dialect = one.first;
    CAPTURE(one.second);
    const Program program = read_program(one.second, "part", {.dialect = dialect});
    const Move& arc = program.moves.back();
    REQUIRE(arc.arc);
    const MoveEdit edit{
        .move = program.moves.size() - 1, .end_mm = arc.end_mm, .orientation = arc.orientation->end};
    const Program lines = read_program(rewrite(program, {edit}, {}).text, "part", {.dialect = dialect});
    REQUIRE(!lines.moves.back().arc);
    const std::string of_arc = kept_words(program, arc), of_line = kept_words(lines, lines.moves.back());
    CAPTURE(of_arc);
    CAPTURE(of_line);
    CHECK(are_alike(of_arc, of_line));
    CHECK(of_arc != of_line);
    CHECK(!are_alike(of_arc, of_arc + "1"));
  }
}
