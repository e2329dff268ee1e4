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
                                             "harmless_calls of the machine file states"));
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

TEST_CASE("a call beside words of a motion is not harmless, and a call of a block number never is") {
  const auto is_called = [](const std::string& dialect, const std::string& block, const std::string& name) {
    CAPTURE(block);
    const CallCase call{dialect, block, name, gcode_with};
    const Program program = read_program(gcode_with(block + "\n"), "p", options_of(call, {name}));
    return std::any_of(program.left_alone.begin(), program.left_alone.end(),
                       [](const LeftAlone& left) { return left.why.starts_with("a subprogram is called"); });
  };
  CHECK(is_called("fanuc", "X3. M98 P9001", "O9001"));
  const CallCase siemens{"siemens", "", "", gcode_with};
  CHECK(read_program(gcode_with("X3 L700\n"), "p", options_of(siemens, {"L700"})).left_alone.size() > 0);
  CHECK(is_called("haas", "M97 P100", "O100"));
  CHECK_FALSE(is_called("haas", "M98 P100", "O100"));
  CHECK_FALSE(is_called("fanuc", "G28 Z0. M98 P9001", "O9001"));
}

TEST_CASE("a call in the block of a machine position is not lost") {
  for (const char* move : {"G28 Z0.", "G53 Z0."}) {
    CAPTURE(move);
    const CallCase call{"fanuc", "", "", gcode_with};
    const Program program =
        read_program(gcode_with(std::string(move) + " M98 P9001\n"), "p", options_of(call, {}));
    REQUIRE(program.left_alone.size() >= 2);
    CHECK(program.left_alone[0].machine_position);
    CHECK(program.left_alone[1].why.starts_with("a subprogram is called"));
    REQUIRE(!program.remarks.empty());
    CHECK(program.remarks[0].what.starts_with("assumed from here on: called programs do not change"));
    CHECK_FALSE(program.moves.back().known_start[0]);
  }
}

TEST_CASE("F, S and T of G65 are arguments of the macro") {
  const CallCase call{"fanuc", "", "", gcode_with};
  const auto last = [&](const std::string& block) {
    return read_program("T1 M6\n" + gcode_with(block + "M6\nG1 X9.\n"), "p", options_of(call, {"O9001"}))
        .moves.back();
  };
  const Move with = last("G65 P9001 F30. S100 T7\n"), without = last("");
  CHECK(with.feed_mm_min == without.feed_mm_min);
  CHECK(with.spindle_rpm == without.spindle_rpm);
  CHECK(with.tool == without.tool);
}

TEST_CASE("a subprogram of the text is not harmless, also where its name is stated") {
  const auto is_stated = [](const std::string& dialect, const std::string& name, const std::string& text) {
    CAPTURE(text);
    const CallCase call{dialect, "", "", gcode_with};
    const Program program = read_program(text, "p", options_of(call, {name}));
    return std::any_of(program.remarks.begin(), program.remarks.end(),
                       [](const Remark& remark) { return remark.what.starts_with("assumed: '"); });
  };
  const std::string fanuc = "O1\n" + gcode_with("M98 P9001\n") + "M30\n";
  CHECK(is_stated("fanuc", "O9001", fanuc + "O9002\nG91 X3.\nM99\n"));
  CHECK_FALSE(is_stated("fanuc", "O9001", fanuc + "O9001 (MOVES)\nG91 X3.\nM99\n"));
  CHECK_FALSE(is_stated("fanuc", "O9001", fanuc + " o09001\nG91 X3.\nM99\n"));
  const std::string word = gcode_with("o<on> call\n") + "M2\n";
  CHECK(is_stated("linuxcnc", "ON", "o<off> sub\nG0 X3\no<off> endsub\n" + word));
  CHECK_FALSE(is_stated("linuxcnc", "ON", "o<On> sub\nG0 X3\no<on> endsub\n" + word));
  CHECK_FALSE(is_stated("linuxcnc", "O100", "o100 sub\nG0 X3\no100 endsub\n" + gcode_with("o100 call\n")));
  const std::string siemens = gcode_with("CLAMPS\n") + "M30\n";
  CHECK(is_stated("siemens", "CLAMPS", siemens));
  CHECK_FALSE(is_stated("siemens", "CLAMPS", "%_N_MAIN_MPF\n" + siemens + "%_N_CLAMPS_SPF\nG91 X3\nM17\n"));
  CHECK_FALSE(is_stated("siemens", "CLAMPS", siemens + "PROC CLAMPS(REAL A)\nG91 X3\nM17\n"));
  CHECK_FALSE(is_stated("siemens", "CLAMPS", siemens + " proc clamps SAVE DISPLOF\r\nG91 X3\nM17\n"));
  CHECK(is_stated("siemens", "CLAMPS", siemens + "PROC CLAMPS2 SAVE\nG91 X3\nM17\n"));
}

TEST_CASE("CALL and RUN of FANUC TP are not parts of names") {
  const auto left_alone = [](const std::string& statement, const std::string& name) {
    const CallCase call{"fanuc_tp", "", "", tp_with};
    return read_program(tp_with(statement + " ;\n"), "p", options_of(call, {name})).left_alone.size();
  };
  CHECK(left_alone("CALL RUNOUT", "OUT") > 0);
  CHECK(left_alone("CALL RUNOUT", "RUNOUT") == 0);
  CHECK(left_alone("RUN OUT", "OUT") == 0);
}
