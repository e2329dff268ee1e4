// Faults of writers of robot programs: each is found by the reading or by the verification.
#include "compensation/robot/writer_faults.hpp"

#include <doctest/doctest.h>

#include <set>

#include "compensation/robot/written_programs.hpp"
#include "compensation/support/arm.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

// A line of the text, and what a fault makes of it.
const std::string dropped, doubled = "$&$&";

std::vector<StatementFault> krl_faults() {
  return {{"external axis changed", ",E1 0\\.0", ",E1 5.0"},
          {"external axis of a target lost", "(B 9[^}]*),E1 0\\.0", "$1"},
          {"speed changed", "CP=0\\.025", "CP=0.25"},
          {"status changed", ",S 2", ",S 6"},
          {"status lost", ",S 2", ""},
          {"turn added", ",S 2", ",S 2,T 2"},
          {"approximation lost", " C_DIS", ""},
          {"another approximation", " C_DIS", " C_VEL"},
          {"a line becomes a rapid", "\nLIN", "\nPTP"},
          {"a rapid becomes a line", "\nPTP", "\nLIN"},
          {"a line is dropped", "\nLIN [^\n]*(?=\n)", dropped},
          {"a line is doubled and shifted", "\nLIN (\\{X 1[^\n]*)(?=\n)", "\nLIN {X 100.0,Y 50.0,Z 5.0}$&"},
          {"the end of an arc is dropped", "\nCIRC [^\n]*(?=\nLIN)", dropped},
          {"loop ends early", "1 TO ([0-9]+)", "1 TO 2"},
          {"loop begins late", "FOR n = 1", "FOR n = 2"},
          {"array too small", "EDGE\\[[4-9]\\]\n", "EDGE[3]\n"},
          {"index repeated", "EDGE\\[2\\]=", "EDGE[1]="},
          {"element dropped", "EDGE\\[[23]\\]=[^\n]*\n", dropped},
          {"another tool", "TOOL_DATA\\[3\\]", "TOOL_DATA[4]"},
          {"shared target not split", "PTP \\{X 189[^\n]*", "PTP XBOTH"},
          {"shared target not split", "LIN \\{X 189[^\n]*", "LIN XBOTH C_DIS"},
          {"end before the last move", "\nLIN ([^\n]*)\nPTP", "\nEND\nLIN $1\nPTP"}};
}

std::vector<StatementFault> rapid_faults() {
  return {{"external axis changed", "\\],\\[0,9E9", "],[5,9E9"},
          {"external axis lost", "\\],\\[0,9E9", "],[9E9,9E9"},
          {"confdata changed", "\\[0,0,-1,1\\]", "[0,0,0,1]"},
          {"confdata in another order", "\\[0,0,-1,1\\]", "[-1,0,0,1]"},
          {"speed changed", ",v25,", ",v250,"},
          {"another speed", ",v50,", ",v25,"},
          {"stale zone at an inserted target", ",z[01],", ",z5,"},
          {"zone too large", ",z5,", ",z50,"},
          {"zone lost", ",z5,", ",fine,"},
          {"zone of a stop", ",fine,", ",z5,"},
          {"another work object", "\\\\WObj:=table", "\\\\WObj:=wobj0"},
          {"another tool", "spindle", "tool0"},
          {"a line becomes a rapid", "MoveL", "MoveJ"},
          {"a rapid becomes a line", "MoveJ", "MoveL"},
          {"a line is dropped", "\n  MoveL [^\n]*(?=\n)", dropped},
          {"the end of an arc is dropped", "\n  MoveC [^\n]*(?=\n  MoveJ)", dropped},
          {"shared target not split", "MoveJ \\[\\[18[^v]*,", "MoveJ both,"},
          {"shared target not split", "MoveL \\[\\[189[^v]*,", "MoveL both,"},
          {"configuration supervision on", "ConfL\\\\Off", "ConfL\\\\On"}};
}

std::vector<StatementFault> ur_faults() {
  return {{"speed changed", "v=0\\.025", "v=0.25"},
          {"acceleration changed", "a=1\\.0", "a=2.0"},
          {"stale radius at an inserted target", "r=0\\.000[0-9]+(?=\\)\\n  movel)", "r=0.005"},
          {"radius too large", "r=0\\.005", "r=0.050"},
          {"radius lost", ", r=0\\.005", ""},
          {"a line becomes a rapid", "movel\\(", "movej("},
          {"a rapid becomes a line", "movej\\(", "movel("},
          {"a line is dropped", "\n  movel[^\n]*(?=\n)", dropped},
          {"the end of an arc is dropped", "\n  movec[^\n]*(?=\n  movej)", dropped},
          {"a frame is lost", "pose_trans\\(table, (p[^)]*)\\)", "$1"},
          {"another frame", "pose_trans\\(table", "pose_trans(both"},
          {"frame moved", "table = p\\[1\\.7", "table = p[1.701"},
          {"another target", "movel\\(both", "movel(table"},
          {"time added", "movel\\(both, a=1\\.0", "movel(both, a=1.0, t=2"}};
}

std::vector<StatementFault> tp_faults() {
  return {
      {"external axis changed", "E1=     0", "E1=     5"},
      {"external axis lost", ",\n\tE1=[^\n]*", ""},
      {"another frame", "UF : 1", "UF : 2"},
      {"another tool", "UT : 2", "UT : 1"},
      {"configuration changed", "'N U T", "'F U T"},
      {"turn number changed", "T, 0, 0, 0'", "T, 0, 0, 1'"},
      {"speed changed", " 25mm/sec", " 250mm/sec"},
      {"unit of the speed changed", " 25mm/sec", " 25cm/min"},
      {"termination changed", "CNT100", "CNT50"},
      {"termination lost", "CNT100", "FINE"},
      {"stop lost", "FINE", "CNT100"},
      {"acceleration lost", " ACC80", ""},
      {"a line becomes a rapid", ":L P", ":J P"},
      {"a rapid becomes a line", ":J P", ":L P"},
      {"a line is dropped", "\n *[0-9]+:L P[^\n]*(?=\n)", dropped},
      {"another position", ":L P\\[10\\]", ":L P[3]"},
      {"shared position not split", ":L P\\[4\\]", ":L P[1]"},
      {"positions of an arc exchanged", ":C P\\[([0-9]+)\\]( *\n *:  )P\\[([0-9]+)\\]", ":C P[$3]$2P[$1]"},
      {"another frame selected", "UFRAME_NUM=1", "UFRAME_NUM=2"},
      {"another tool selected", "UTOOL_NUM=2", "UTOOL_NUM=1"},
      {"position dropped", "P\\[3\\]\\{[^}]*\\};\n", dropped},
      {"position doubled", "P\\[3\\]\\{[^}]*\\};\n", doubled}};
}

std::vector<StatementFault> jbi_faults() {
  return {{"count of positions", "NPOS [0-9]+", "NPOS 8"},
          {"count of base positions", "(NPOS [0-9]+),[0-9]+", "$1,8"},
          {"configuration changed", "RCONF 1", "RCONF 0"},
          {"numbers of a configuration exchanged", "RCONF 1,0", "RCONF 0,1"},
          {"another tool", "TOOL 2", "TOOL 1"},
          {"another frame", "USER 1", "USER 2"},
          {"another type of frame", "POSTYPE USER", "POSTYPE BASE"},
          {"speed changed", "V=25\\.0", "V=250.0"},
          {"speed of a rapid changed", "VJ=25\\.00", "VJ=50.00"},
          {"position level added", "(MOVL[^\n]*V=50\\.0)\n", "$1 PL=0\n"},
          {"corner radius too large", "CR=[0-9.]+", "CR=50.0"},
          {"a line becomes a rapid", "MOVL (C[^\n]*) V=25.0", "MOVJ $1 VJ=25.0"},
          {"a step is dropped", "MOVL C[^\n]*\n", dropped},
          {"an arc step is dropped", "MOVC C[^\n]*\n", dropped},
          {"end of the arc lost", " FPT", ""},
          {"another position", "MOVL C00003", "MOVL C00005"},
          {"shared position not split", "MOVJ C00012", "MOVJ P00100"},
          {"shared position not split", "MOVL C00011", "MOVL P00100"},
          {"position of the base changed", "BC00003=0", "BC00003=10"},
          {"another position of the base lost", " BC00004", ""},
          {"position dropped", "\nC00003=[^\n]*", dropped},
          {"position doubled", "\nC00003=[^\n]*", doubled},
          {"number repeated", "\nC00004=", "\nC00003="}};
}

std::vector<StatementFault> apt_faults() {
  return {{"unit changed", "UNITS/MM", "UNITS/INCHES"},
          {"feed changed", "FEDRAT/1500", "FEDRAT/150"},
          {"unit of the feed changed", "MMPM", "MMPR"},
          {"another tool", "LOADTL/5", "LOADTL/6"},
          {"spindle changed", "SPINDL/2000", "SPINDL/200"},
          {"a rapid becomes a line", "RAPID\n", dropped},
          {"a line becomes a rapid", "\nGOTO", "\nRAPID\nGOTO"},
          {"a point is dropped", "\nGOTO/1[^\n]*", dropped},
          {"a point is added", "\nGOTO/1[^\n]*", "$&\nGOTO/100.0,50.0,5.0"},
          {"an axis is lost", "(GOTO/1[^,]*,[^,]*,[^,]*),[^\n]*", "$1"},
          {"an axis is turned over", "0\\.99[0-9]*(?=\n)", "-$&"},
          {"a coordinate is lost", "(GOTO/[^,]*),[^,]*,", "$1,"}};
}

std::vector<StatementFault> ngc_faults() {
  return {{"unit changed", "G21", "G20"},
          {"distances become relative", "G90", "G91"},
          {"another plane", "G17", "G18"},
          {"another offset", "G54", "G55"},
          {"feed changed", "F1500", "F150"},
          {"feed of another line", "F3000", "F1500"},
          {"spindle changed", "S9000", "S900"},
          {"another tool", "T3", "T4"},
          {"the other direction of an arc", "\nG2", "\nG3"},
          {"an arc becomes a line", "\nG2([^I]*)I[^\n]*", "\nG1$1"},
          {"a line becomes a rapid", "\nG1", "\nG0"},
          {"a rapid becomes a line", "\nG0", "\nG1"},
          {"a block is dropped", "\n(N|X)[^\n]*(?=\n)", dropped},
          {"centre exchanged", "I([-0-9.]+) J([-0-9.]+)", "I$2 J$1"},
          {"letters of angles exchanged", "A([-0-9.]+) B([-0-9.]+)", "B$1 A$2"},
          {"number of a block moved", "\nN30 ([^\n]*)\n", "\n$1\nN30 "},
          {"M word lost", "\nM5", ""}};
}

std::vector<StatementFault> faults_of(const std::string& dialect) {
  if (dialect == "kuka") return krl_faults();
  if (dialect == "abb") return rapid_faults();
  if (dialect == "ur") return ur_faults();
  if (dialect == "fanuc_tp") return tp_faults();
  if (dialect == "yaskawa") return jbi_faults();
  if (dialect == "apt") return apt_faults();
  return ngc_faults();
}

/// Whether the reading or the verification refuses the text.
bool is_found(const Shop& shop, const std::string& text) {
  try {
    return verify(shop.job(), read_program(text, "corrected", shop.read), false).failure.has_value();
  } catch (const InputError&) {
    return true;
  }
}

Order order_of(const WrittenProgram& program) {
  Order order{.machine = arm_machine(), .text = program.text};
  order.force = constant_force((Vector6() << 120, -300, -80, 2, 5, -3).finished());
  order.max_correction = 20e-3;
  if (program.dialect != "ur") order.X_MW = translation({1.7, 0, 0.6});
  order.read.dialect = program.dialect;
  order.read.tool_orientation = true;
  return order;
}

}  // namespace

TEST_CASE("200 seeded faults in the text of corrected robot programs are all found") {
  std::set<std::string> texts;
  for (const WrittenProgram& program : written_programs()) {
    CAPTURE(program.dialect);
    Shop shop(order_of(program));
    shop.options.spin_tolerance = 0.02 * deg;
    const Compensation result = compensated(shop);
    CHECK(result.counts.inserted_blocks > 0);
    REQUIRE(!is_found(shop, result.text));
    std::vector<Fault> faults = NumberFaults(program, result.text, 21).make(2);
    for (Fault& fault : statement_faults(result.text, faults_of(program.dialect), 22))
      faults.push_back(std::move(fault));
    std::size_t made = 0;
    for (const Fault& fault : faults) {
      if (!texts.insert(fault.text).second) continue;
      CAPTURE(fault.what);
      CHECK(fault.text != result.text);
      CHECK(is_found(shop, fault.text));
      ++made;
    }
    CHECK(made >= 30);
  }
  CHECK(texts.size() >= 200);
}
