// Calls that the machine file states as harmless, in all languages.
#include <doctest/doctest.h>

#include <algorithm>
#include <functional>

#include "counterflex/program/read_program.hpp"
#include "program/robot/fanuc/fanuc.hpp"
#include "program/robot/rapid/rapid.hpp"
#include "program/robot/ur/ur.hpp"
#include "program/robot/yaskawa/yaskawa.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// The text of a program with this call between two moves.
using TextWithCall = std::function<std::string(const std::string&)>;

struct CallCase {
  std::string dialect, call, stated;
  TextWithCall text;
};

std::string krl_with(const std::string& call, const std::string& more = "") {
  return "DEF job()\nLIN {X 1,Y 0,Z 0,A 0,B 0,C 0}\n" + call + "LIN {X 5,Y 0,Z 0,A 0,B 0,C 0}\nEND\n" + more;
}

std::string rapid_with(const std::string& call, const std::string& more = "") {
  const auto move = [](const char* place) { return "MoveL " + target_at(place) + ",v100,fine,tool0;\n"; };
  std::string text = module_of("", move("1,0,0") + call + move("5,0,0"));
  return text.insert(text.rfind("ENDMODULE"), more);
}

std::string tp_with(const std::string& call) {
  return tp_program(
      "UFRAME_NUM=1 ;\nUTOOL_NUM=2 ;\nL P[1] 50mm/sec FINE ;\n" + call + "L P[2] 50mm/sec FINE ;\n",
      tp_square());
}

std::string jbi_with(const std::string& call) {
  return job_of(jbi_positions_text, "MOVL C00001 V=66.7 PL=0\n" + call + "MOVL C00002 V=66.7 PL=0\n");
}

std::string ur_with(const std::string& call, const std::string& more = "") {
  return ur_program_of(more + "movel(p[0,0,0.1,0,0,0])\n" + call + "movel(p[0.1,0,0.1,0,0,0])\n");
}

std::string gcode_with(const std::string& call) {
  return "G90 G94 G17\nG1 X1 Y0 Z0 F100\n" + call + "X5\n";
}

std::string klartext_with(const std::string& call) {
  return "BEGIN PGM P MM\nL X+1 Y+0 Z+0 R0 F100\n" + call + "L X+5\nEND PGM P MM\n";
}

std::vector<CallCase> calls() {
  return {
      {"kuka", "SPINDLE_ON(3)\n", "SPINDLE_ON", [](const auto& call) { return krl_with(call); }},
      {"abb", "SpindleOn 3000;\n", "SPINDLEON", [](const auto& call) { return rapid_with(call); }},
      {"fanuc_tp", "CALL SPINDLE_ON(3000) ;\n", "SPINDLE_ON", tp_with},
      {"fanuc_tp", "HAND OPEN ;\n", "HANDOPEN", tp_with},
      {"fanuc_tp", "IF R[1]=1,CALL SPINDLE_ON ;\n", "SPINDLE_ON", tp_with},
      {"yaskawa", "CALL JOB:SPINDLE_ON\n", "SPINDLE_ON", jbi_with},
      {"yaskawa", "SPINDLE SSP=3000\n", "SPINDLE", jbi_with},
      {"ur", "Spindle_on(3)\n", "SPINDLE_ON", [](const auto& call) { return ur_with(call); }},
      {"fanuc", "M98 P9001\n", "O9001", gcode_with},
      {"fanuc", "G65 P9001 X10. Y20.\n", "O9001", gcode_with},
      {"haas", "G65 P9001 A1.\n", "O9001", gcode_with},
      {"linuxcnc", "o<spindle_on> call [3000]\n", "SPINDLE_ON", gcode_with},
      {"siemens", "L700\n", "L700", gcode_with},
      {"siemens", "Spindle_On(3000)\n", "SPINDLE_ON", gcode_with},
      {"siemens", "EXTCALL(\"SPINDLE\")\n", "SPINDLE", gcode_with},
      {"siemens", "CALL \"SPINDLE\"\n", "SPINDLE", gcode_with},
      {"heidenhain", "CALL PGM TNC:\\Macros\\spindle.h ; on\n", "TNC:\\MACROS\\SPINDLE.H", klartext_with}};
}

ReadOptions options_of(const CallCase& call, CallNames harmless) {
  ReadOptions options;
  options.dialect = call.dialect;
  options.unit = LengthUnit::millimetres;
  options.harmless_calls = std::move(harmless);
  return options;
}

}  // namespace

TEST_CASE("a call that is stated as harmless leaves position, feed and state, and is a remark") {
  for (const CallCase& call : calls()) {
    CAPTURE(call.call);
    const Program without = read_program(call.text(""), "p", options_of(call, {}));
    const Program stated = read_program(call.text(call.call), "p", options_of(call, {call.stated}));
    CHECK(stated.left_alone.size() == without.left_alone.size());
    REQUIRE(stated.moves.size() == without.moves.size());
    const Move &last = stated.moves.back(), &same = without.moves.back();
    CHECK(last.start_mm == same.start_mm);
    CHECK(last.known_start == same.known_start);
    CHECK(last.feed_mm_min == same.feed_mm_min);
    CHECK(last.may_split == same.may_split);
    REQUIRE(stated.remarks.size() == without.remarks.size() + 1);
    CHECK(stated.remarks.back().what.starts_with("assumed: '"));
    CHECK(
        stated.remarks.back().what.ends_with("neither moves the machine nor changes its state, as [program] "
                                             "harmless_calls of the machine file has "
                                             "it"));
  }
}

TEST_CASE("a call of another program is judged as before") {
  for (const CallCase& call : calls()) {
    CAPTURE(call.call);
    const Program other = read_program(call.text(call.call), "p", options_of(call, {"OTHER"}));
    const Program without = read_program(call.text(""), "p", options_of(call, {}));
    CHECK(other.left_alone.size() + other.moves.size() > without.left_alone.size() + without.moves.size());
    REQUIRE(!other.remarks.empty());
    CHECK(other.remarks.back().what.starts_with("assumed from here on: called programs do not change"));
  }
}

TEST_CASE("a routine of the text is judged by its text, also where its name is stated as harmless") {
  const auto may_move = [](const std::string& text, const char* dialect) {
    ReadOptions options;
    options.dialect = dialect;
    options.harmless_calls = {"PART", "SPINDLE_ON"};
    const Program program = read_program(text, "p", options);
    return std::any_of(program.left_alone.begin(), program.left_alone.end(), [](const LeftAlone& block) {
      return block.why == "the call of 'part' may move the robot";
    });
  };
  CHECK(may_move(krl_with("part()\n", "DEF part()\nPTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\nEND\n"), "kuka"));
  CHECK_FALSE(may_move(krl_with("part()\n", "DEF part()\nSPINDLE_ON()\nEND\n"), "kuka"));
  CHECK(may_move(krl_with("part()\n", "DEF part()\nSPINDLE_OFF()\nEND\n"), "kuka"));
  const std::string move = "MoveL " + target_at("9,0,0") + ",v100,fine,tool0;\n";
  CHECK(may_move(rapid_with("part;\n", "PROC part()\n" + move + "ENDPROC\n"), "abb"));
  CHECK_FALSE(may_move(rapid_with("part;\n", "PROC part()\nspindle_on;\nENDPROC\n"), "abb"));
  CHECK(may_move(rapid_with("part;\n", "PROC part()\nspindle_off;\nENDPROC\n"), "abb"));
  CHECK_FALSE(may_move(ur_with("part()\n", "def part():\nspindle_on(3)\nend\n"), "ur"));
  CHECK(may_move(ur_with("part()\n", "def part():\nspindle_off()\nend\n"), "ur"));
  CHECK(may_move(ur_with("part()\n", "def part():\nmovel(p[0.9,0,0.1,0,0,0])\nend\n"), "ur"));
}
