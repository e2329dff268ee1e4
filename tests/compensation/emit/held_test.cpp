// Blocks that are not corrected one by one: what cannot hold a correction refuses it.
#include "compensation/support/gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

std::optional<Failure> failure_on(const Machine& machine, const std::string& text) {
  return Shop({.machine = machine, .text = text}).run().failure;
}

}  // namespace

TEST_CASE("an axis that an expression sets refuses a correction, and passes without one") {
  const std::string text = "G21 G90\n#1=20\nG0 X0. Y0. Z5.\nG1 Z0. F300\nX#1\nX30.\nG0 Z20.\nM30\n";
  CHECK(!failure_on(perfect_gantry(), text));
  CHECK(compensated(Shop({.machine = perfect_gantry(), .text = text})).text == text);
  const auto failure = failure_on(displaced_gantry(), text);
  REQUIRE(failure);
  CHECK(failure->kind == ErrorKind::program_text);
  CHECK(failure->line == 5);
  CHECK(failure->what.find("-0.5000 mm") != std::string::npos);
}

TEST_CASE("what puts positions elsewhere refuses a correction that holds, and passes without one") {
  const std::string begin = "G21 G90\nG0 X0. Y0. Z5.\nG1 X5. F300\n", end = "X10.\nM30\n";
  for (const char* elsewhere : {"A90.\n", "G52 X#1\n", "G92 X#1\n", "G10 L2 P1 X#1\n", "M428\n",
                                "o1 if [#1 GT 2]\nX7.\no1 endif\n"}) {
    CAPTURE(elsewhere);
    const std::string text = begin + elsewhere + end;
    CHECK(compensated(Shop({.machine = perfect_gantry(), .text = text})).text == text);
    const auto failure = failure_on(displaced_gantry(), text);
    REQUIRE(failure);
    CHECK(failure->line == 5);
    CHECK(failure->kind == ErrorKind::program_text);
    // Behind a machine position nothing holds that could be lost.
    CHECK_FALSE(failure_on(displaced_gantry(), begin + "G53 X0 Y0 Z0\n" + elsewhere + end));
  }
}

TEST_CASE("an expression on one axis lets the others keep their shift") {
  // Displaced in Y alone: X takes no correction.
  const std::string text = "G21 G90\n#1=20\nG0 X0. Y0. Z5.\nX#1 Y10.\nX30. Y20.\nM30\n";
  const Compensation result = compensated(Shop({.machine = rigid_gantry("0, -0.25, 0"), .text = text}));
  const auto lines = lines_of(result.text);
  CHECK(lines[3] == "X#1 Y10.25");
  CHECK(lines[4] == "X30. Y20.25");
}

TEST_CASE("a relative expression carries the shift along, and an absolute one after it is refused") {
  const std::string carried = "G21 G90\n#1=20\nG0 X0. Y0. Z5.\nG91 X#1\nG90 Y10.\nX30. Y20.\nM30\n";
  const Compensation result = compensated(Shop({.machine = displaced_gantry(), .text = carried}));
  const auto lines = lines_of(result.text);
  CHECK(lines[3] == "G91 X#1");
  CHECK(lines[4] == "G90 Y10.25");
  CHECK(lines[5] == "X29.5 Y20.25");
  const auto failure =
      failure_on(displaced_gantry(), "G21 G90\n#1=20\nG0 X0. Y0. Z5.\nG91 X#1\nG90 X#1\nX30. Y20.\nM30\n");
  REQUIRE(failure);
  CHECK(failure->line == 5);
}

TEST_CASE("a call of a subprogram refuses a correction that holds") {
  const std::string text =
      "G21 G90\no100 sub\nG0 X50.\no100 endsub\nG0 X0. Y0. Z5.\no100 call\nG0 X1. Y2. Z3.\nM30\n";
  CHECK(!failure_on(perfect_gantry(), text));
  const auto failure = failure_on(displaced_gantry(), text);
  REQUIRE(failure);
  CHECK(failure->kind == ErrorKind::program_text);
  CHECK(failure->line == 6);
}

TEST_CASE("a definition between the moves ends no correction: the call behind it refuses it") {
  const std::string end = "G0 X1. Y2. Z3.\nM30\n";
  for (const char* call : {"o100 call\n", "o[100] call\n", "M98 P77\n"}) {
    CAPTURE(call);
    const std::string text = "G21 G90\nG0 X0. Y0. Z5.\no100 sub\nG0 X50.\no100 endsub [1]\n";
    CHECK(!failure_on(perfect_gantry(), text + call + end));
    const auto failure = failure_on(displaced_gantry(), text + call + end);
    REQUIRE(failure);
    CHECK(failure->line == 6);
  }
}

TEST_CASE("a subprogram that is not called does not change what is corrected") {
  const std::string text =
      "G21 G90\nG0 X0. Y0. Z5.\no100 sub\nG91 G1 X50. F100\no100 endsub\nG1 X10. F200\nM30\n";
  const Compensation result = compensated(Shop({.machine = displaced_gantry(), .text = text}));
  CHECK(lines_of(result.text)[3] == "G91 G1 X50. F100");
  CHECK(lines_of(result.text)[5] == "G1 X9.5 F200");
}

TEST_CASE("a cycle or macro called at a known place refuses its correction behind any block") {
  const std::string klartext =
      "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nL X+0 Y+0 Z+50 R0 FMAX M3\nTOOL CALL 2 Z S1000\n";
  const std::string thread =
      "CYCL DEF 262 THREAD MILLING Q335=10 Q239=1.5 Q201=-8 Q355=0 Q253=750 Q351=1 Q200=2 Q203=+0 Q204=50\n";
  const std::string pattern = "CYCL DEF 231 RULED SURFACE Q225=0\n",
                    end = "L Z+100 R0 FMAX M2\nEND PGM A MM\n";
  const std::string fanuc = "O1\nG21 G90 G17 G54\nT1 M6\nG0 X0. Y0. Z50.\nT2 M6\n";
  const std::string siemens = "G71 G90 G17 G54\nG0 X0 Y0 Z50\nT2 M6\n";
  for (const std::string& text :
       {klartext + "L Z+50 R0 FMAX\n" + thread + "L X+10 Y+10 R0 FMAX M99\n" + end,
        klartext + "L X+0 Y+0 Z+50 R0 FMAX\n" + thread + "L X+10 Y+10 R0 FMAX M99\n" + end,
        klartext + "L X+10 Y+10 R0 FMAX\n" + thread + "L Z+50 R0 FMAX M99\n" + end,
        klartext + thread + "L X+10 Y+10 Z+50 R0 FMAX M99\n" + end,
        klartext + "L Z+50 R0 FMAX\n" + pattern + "L X+10 Y+10 R0 FMAX M99\n" + end,
        fanuc + "G0 Z50.\nG66 P9000 Z-10.\nX10. Y10.\nG67\nM30\n",
        fanuc + "G0 Z50.\nX10. Y10. M98 P900\nM30\n", fanuc + "X10. Y10. Z50. M98 P900\nM30\n",
        fanuc + "G66 P9000 Z-10.\nX10. Y10. Z50.\nG67\nM30\n",
        siemens + "G0 Z50\nMCALL FOO(50,0,2,-10)\nX10 Y10\nMCALL\nM30\n"}) {
    CAPTURE(text);
    CHECK(compensated(Shop({.machine = perfect_gantry(), .text = text})).text == text);
    const auto failure = failure_on(displaced_gantry(), text);
    REQUIRE(failure);
    CHECK(failure->kind == ErrorKind::program_text);
    const std::string line = lines_of(text)[static_cast<std::size_t>(failure->line) - 1];
    CHECK((line.ends_with("M99") || line.starts_with("X10")));
  }
}

TEST_CASE("where words put a cycle that is not corrected, its own correction counts") {
  // Inclined about Y by 1 mm in 1000 mm: nothing is left at X0, 0.1 mm at X100.
  Machine machine = perfect_gantry();
  std::get<AssemblyError>(machine.chains[0].elements[0]).X.R = exp_so3(Vector3(0, -1e-3, 0));
  const auto failure =
      failure_on(machine, "O1\nG21 G90 G17 G54\nG0 X0. Y0. Z0.\nG66 P9000 Z-10.\nX100. Y10.\nG67\nM30\n");
  REQUIRE(failure);
  CHECK(failure->line == 5);
  CHECK(failure->what.find("0.1000 mm") != std::string::npos);
}

TEST_CASE("a Z word in a block that calls a macro is named as the cause of the refusal") {
  const std::string begin = "G71 G90 G17 G54 G94\nG0 X10 Y10 Z60\nMCALL CYCLE82(50,0,2,-10)\nX20 Y20\n";
  const auto failure = failure_on(displaced_gantry(), begin + "X50 Y90 Z55\nMCALL\nM30\n");
  REQUIRE(failure);
  CHECK(failure->line == 5);
  CHECK(
      failure->what ==
      "a block that calls a macro keeps its Z word: program this height in a block of its own "
      "before MCALL; Z stays where it is, and the correction of -0.1250 mm that holds there cannot be kept");
}

TEST_CASE("siemens: a block that takes no words beside IC or AC is listed with this reason") {
  for (const std::string block : {"Y=IC(60)", "G91 X10\nY=AC(60)"}) {
    CAPTURE(block);
    const Compensation result = compensated(
        Shop({.machine = rigid_gantry("0, 0, 0.1", 1e-3),
              .text = "G71 G90 G17 G54 G94\nG0 X10 Y10 Z60\nMCALL CYCLE82(50,0,2,-10)\nX20 Y20\n" + block +
                      "\nMCALL\nM30\n"}));
    CAPTURE(result.text);
    REQUIRE(result.left_alone.size() == 1);
    CHECK(
        result.left_alone[0].why.starts_with("a block with IC under G90 or with AC under G91 (write G91 or "
                                             "G90 instead) takes no further axis words"));
  }
}

TEST_CASE("a cycle that is not corrected passes where the place of its call is not known") {
  for (const char* text : {"O1\nG21 G90 G17 G54\nG28\nG0 X0. Y0.\nG66 P9000 Z-10.\nX10. Y10.\nG67\nM30\n",
                           "O1\nG21 G90 G17 G54\nG28\nG66 P9000 Z-10.\nX10. Y10. Z#1\nG67\nM30\n",
                           "O1\nG21 G90 G17 G54\nG0 X0. Y0. Z50.\nG28 X0. Y0. Z0. M98 P900\nM30\n"}) {
    CAPTURE(text);
    CHECK(!failure_on(displaced_gantry(), text));
  }
}

TEST_CASE("a call is refused where the text holds a correction that is not needed at its place") {
  // Inclined about Y: 0.1 mm is needed at X100, nothing at X0.
  Machine machine = perfect_gantry();
  std::get<AssemblyError>(machine.chains[0].elements[0]).X.R = exp_so3(Vector3(0, -1e-3, 0));
  const std::string text = "O1\nG21 G90 G17 G54\nG0 X100. Y0. Z0.\nG66 P9000 Z-10.\nX0. Y10.\nG67\nM30\n";
  const auto failure = failure_on(machine, text);
  REQUIRE(failure);
  CHECK(failure->line == 5);
}

TEST_CASE("after a machine position an axis holds nothing, also where the work offset changes") {
  for (const char* change : {"", "G55\n", "G52 X5.\n", "G55\nG52 X5.\n"}) {
    CAPTURE(std::string(change));
    const std::string text = std::string("O1\nG21 G90 G17 G54\nG0 X0. Y0. Z5.\nG53 G0 Z0.\nG53 X0. Y0.\n") +
                             change + "G0 X10.\nY20.\nG1 X30. F100\nM30\n";
    const std::vector<std::string> lines =
        lines_of(compensated(Shop({.machine = displaced_gantry(), .text = text})).text);
    CHECK(lines[lines.size() - 5] == "G0 X10.");
    CHECK(lines[lines.size() - 4] == "Y20.");
    CHECK(lines[lines.size() - 3] == "G1 X30. F100");
  }
}

TEST_CASE("after a machine position an axis holds nothing that an expression could break") {
  const std::string text = "G21 G90\n#1=20\nG0 X0. Y0. Z5.\nG53 G0 Z0.\nZ#1\nM30\n";
  CHECK(!failure_on(displaced_gantry(), text));
}

TEST_CASE("a thread under G33 keeps the correction with which it is entered") {
  const std::string text = "G21 G90\nG0 X0. Y50. Z5.\nG33 Z-20. K1.5\nG0 Z5.\nM30\n";
  const Compensation result = compensated(Shop({.machine = displaced_gantry(), .text = text}));
  CHECK(lines_of(result.text)[2] == "G33 Z-20.125 K1.5");
}
