// What verify refuses besides deviations: moves that no check would judge, and other text that differs.
#include <fmt/format.h>

#include <utility>

#include "compensation/support/gantry.hpp"
#include "compensation/support/shop.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string spindle_stop = "G21 G90 G54\nG0 X0 Y0 Z5\nG1 Z0 F100\nX10\nM5\nM30\n";

/// The line and words with which `changed` is refused as the corrected form of `original`.
std::string refusal(const std::string& changed, const std::string& original = spindle_stop) {
  const Shop shop({.machine = load_machine(orthoglide_perfect), .text = original});
  const auto failure = verify(shop.job(), read_program(changed, "changed.ngc", {}), false).failure;
  if (!failure) return "";
  CHECK(failure->kind == ErrorKind::not_compensated);
  return fmt::format("{}, original {}: {}", failure->corrected_line, failure->line, failure->what);
}

std::string replaced(const std::string& what, const std::string& by) {
  std::string changed = spindle_stop;
  return changed.replace(changed.find(what), what.size(), by);
}

}  // namespace

TEST_CASE("a program is its own corrected form where nothing has to be corrected") {
  CHECK(refusal(spindle_stop).empty());
  CHECK(refusal("(COUNTERFLEX 1 VERSION 0.1.0)\n" + spindle_stop).empty());
}

TEST_CASE("moves that leave the path and come back are refused") {
  CHECK_FALSE(refusal(replaced("X10\n", "X10\nX10 Y50\nX10 Y0\n")).empty());
  CHECK_FALSE(refusal(replaced("X10\n", "X5 Y20\nX5 Y0\nX10\n")).empty());
  CHECK_FALSE(refusal(replaced("X10\n", "X5\nX4 Y0.5\nX10\n")).empty());
  CHECK(refusal(replaced("X10\n", "X5\nZ-0.4\nZ0\nX10\n")).find("misses the path by 0.4000 mm") !=
        std::string::npos);
}

TEST_CASE("an arc that is left at one of its places is refused") {
  const auto with = [](const char* cut) {
    return fmt::format("G21 G90 G17\nG0 X0 Y0 Z5\nG1 Z0 F100\n{}M30\n", cut);
  };
  const std::string arc = with("G2 X10 Y10 I10 J0\n");
  const auto halves = [&](const char* between) {
    return with(fmt::format("G2 X2.929 Y7.071 I10 J0\n{}G2 X10 Y10 I7.071 J-7.071\n", between).c_str());
  };
  CHECK(refusal(halves(""), arc).empty());
  for (const char* away : {"G1 Z-30\nZ0\n", "G1 X2.2 Y7.8\nX2.929 Y7.071\n", "G1 Z-3\nZ-1\nZ0\n"}) {
    CAPTURE(away);
    CHECK(refusal(halves(away), arc).find("misses the path by") != std::string::npos);
  }
}

TEST_CASE("a place that the original states is stated") {
  CHECK(refusal(replaced("X0 Y0 ", "")) ==
        "2, original 2: the position in X is not known here: no move before has a word for it");
  const std::string holes = "G21 G90 G17\nG0 X0 Y0 Z5\nG98 G81 X10 Y0 Z-5 R2 F100\nX20\nG80\nM30\n";
  std::string without_y = holes;
  for (const char* word : {"Y0 Z5", "Y0 Z-5"}) without_y.erase(without_y.find(word), 3);
  CHECK(refusal(without_y, holes).find("the position in Y is not known here") != std::string::npos);
  std::string lower = holes;
  lower.insert(lower.find("X20") + 3, " R0.4");
  CHECK(refusal(lower, holes) ==
        "4, original 4: the retract plane R is shifted by -1.6000 mm, the bottom of the hole by 0.0000 mm");
}

TEST_CASE("the mark of UTF-8 stays before the header") {
  const std::string mark = "\xEF\xBB\xBF", text = mark + spindle_stop;
  CHECK(refusal(text, text).empty());
  CHECK(refusal(mark + "(COUNTERFLEX 1 VERSION 0.1.0)\n" + spindle_stop, text).empty());
}

TEST_CASE("a line that holds no move has to stay as it is") {
  const std::string differs =
      "this line differs from that of the original; it is not a move and must not change";
  CHECK(refusal(replaced("G54", "G55")) == "1, original 1: " + differs);
  CHECK(refusal(replaced("M5\n", "")) == "5, original 5: " + differs);
  CHECK(refusal(replaced("M30\n", "M30\nM3\n")) == "7, original 0: the original has no such line");
  CHECK(refusal(replaced("M30\n", "")) ==
        "0, original 6: this line of the original is missing at the end of the corrected program");
}

TEST_CASE("words of a move that correction never changes have to stay") {
  CHECK(
      refusal(replaced("F100", "F1000")) ==
      "3, original 3: the moves from here on do not end where that of the original does, with the same words "
      "(motion, F, S, M)");
}

TEST_CASE("the N of a block belongs to its first piece") {
  const auto program = [](const std::string& first, const std::string& second) {
    return fmt::format("G21 G90 G54\nG0 X0 Y0 Z5\n{}\n{}\nG0 Z5\nM30\n", first, second);
  };
  const std::string down = "N30 G1 Z0 F100";
  const std::string wrong =
      "the N of a block belongs to its first piece, and other pieces of a block without N have none";
  const auto refused = [&](const std::string& original, const std::string& changed) {
    const Shop shop({.machine = load_machine(orthoglide_perfect), .text = original});
    const auto failure = verify(shop.job(), read_program(changed, "changed.ngc", {}), false).failure;
    return failure ? fmt::format("{}: {}", failure->corrected_line, failure->what) : "";
  };
  const std::string numbered = program(down, "N40 X10"), plain = program(down, "X10");
  CHECK(refused(numbered, program(down, "N40 X5\nX10")).empty());
  CHECK(refused(numbered, program(down, "N40 X5\nN41 X10")).empty());
  CHECK(refused(numbered, program(down, "X5\nN40 X10")) == "4: " + wrong);
  CHECK(refused(numbered, program(down, "X10")) == "4: " + wrong);
  CHECK(refused(numbered, program("N31 G1 Z0 F100", "N40 X10")) == "3: " + wrong);
  CHECK(refused(plain, program(down, "X5\nX10")).empty());
  CHECK(refused(plain, program(down, "X5\nN41 X10")) == "5: " + wrong);
}

TEST_CASE("a split Klartext program has the numbers of its own order and each kind of feed") {
  for (const std::string feed : {"F500", "FAUTO", "F AUTO", "FU0.5", "FZ0.1"}) {
    CAPTURE(feed);
    const Shop shop(
        {.machine = load_machine(small_mill),
         .text = "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S1000 F300\n2 L X+0 Y+0 Z+0 R0 FMAX\n3 L X+250 " + feed +
                 "\n4 L Y+250\n5 L X+0\n6 END PGM A MM\n",
         .force = step_profile("0, 50, 0, 0\n60, 215, -10, -25\n340, 20, 100, -25\n", 2e-3)});
    const Compensation result = compensated(shop);
    REQUIRE(result.counts.inserted_blocks > 0);
    const auto failure = verify(shop.job(), read_program(result.text, "c.h", {}), false).failure;
    CHECK(!failure);
  }
}

TEST_CASE("under G93 the pieces of a block take its time") {
  const auto program = [](const char* across) {
    return fmt::format("G21 G90 G54\nG0 X0 Y0 Z0\nG93 G1 X40 F20\n{}\nG94\nM2\n", across);
  };
  const Shop shop({.machine = rigid_gantry("0, 0, 0"), .text = program("X80 F10")});
  const auto refused = [&](const char* across) {
    const auto failure = verify(shop.job(), read_program(program(across), "changed.ngc", {}), false).failure;
    return failure ? failure->what : "";
  };
  CHECK(refused("X80 F10").empty());
  CHECK(refused("X60 F20\nX80 F20").empty());
  for (const char* across : {"X80 F100", "X60 F10\nX80 F10"})
    CHECK(refused(across).find("min here, in the original 0.1 min") != std::string::npos);
}

TEST_CASE("a piece has its share of the time, and a feed that is not known is the same text") {
  const auto program = [](const std::string& cut) {
    return fmt::format("G21 G90 G54\nG0 X0 Y0 Z5\nG1 Z0 F100\n{}\nG94\nM30\n", cut);
  };
  const std::string timed = program("G93\nG1 X10 F1");
  CHECK(refusal(program("G93\nG1 X5 F2\nX10 F2"), timed).empty());
  CHECK(refusal(program("G93\nG1 X9 F10\nX10 F1.11111"), timed)
            .find("this piece goes 90.0 % of the way of its "
                  "block in 10.0 % of the time") != std::string::npos);
  const std::string per_turn = program("G95\nG1 X10 F0.1");
  CHECK(refusal(program("G95\nG1 X5 F0.1\nX10 F0.1"), per_turn).empty());
  CHECK(refusal(program("G95\nG1 X5 F0.9\nX10 F0.1"), per_turn)
            .find("the feed is F0.9 here, in the original "
                  "'F0.1'") != std::string::npos);
}

TEST_CASE("a length keeps its point where a control may read it in units of 0.001 mm") {
  const std::string text = "O1\nG21 G90 G54\nG0 X0. Y0. Z5.\nG1 Z0. F100.\nX10.\nG0 Z5.\nM30\n";
  const auto refused = [&](const std::string& changed) {
    Order order{.machine = load_machine(orthoglide_perfect), .text = text};
    order.read.dialect = "fanuc";
    const Shop shop(order);
    const auto failure = verify(shop.job(), read_program(changed, "changed.nc", order.read), false).failure;
    return failure ? failure->what : "";
  };
  CHECK(refused(text) == "");
  std::string edited = text;
  edited.erase(edited.rfind("Z5.") + 2, 1);
  CHECK(refused(edited).starts_with("a length of this block has no point"));
}

TEST_CASE("a split block is the first of its pieces with any word that acts at its beginning") {
  for (const std::string word : {"SPOS=90", "MSG(\"CUT\")", "R5=3", "M3=5", "H3", "OVR=50", "STOPRE", "M8"}) {
    CAPTURE(word);
    const Shop shop({.machine = load_machine(small_mill),
                     .text = "G71 G90 G54 F500\nG0 X0 Y0 Z0\nG1 X250 " + word + "\nG1 Y250\nM30\n",
                     .force = step_profile("0, 50, 0, 0\n60, 215, -10, -25\n340, 20, 100, -25\n", 2e-3),
                     .read = {.dialect = "siemens"}});
    const Compensation result = compensated(shop);
    REQUIRE(result.counts.inserted_blocks > 0);
    const Program again = read_program(result.text, "c.mpf", {.dialect = "siemens"});
    CHECK(!verify(shop.job(), again, false).failure);
    const std::size_t first = result.text.find("G1"), second = result.text.find("G1", first + 1);
    CHECK(result.text.find(word) < second);
  }
}

TEST_CASE("a block whose comment sets the force is the first piece of its move") {
  for (const std::string text :
       {"G21 G90 G54 F500\nG0 X0 Y0 Z0\nG1 X40 (FORCE FX=100 FY=0 FZ=50)\nG1 X80\nM2\n",
        "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nL X+0 Y+0 Z+0 R0 FMAX\nL X+40 F500 ; FORCE "
        "FX=100 FY=0 FZ=50\nL X+80\nEND PGM A MM\n"}) {
    CAPTURE(text);
    const Shop shop({.machine = load_machine(small_mill), .text = text});
    const Compensation result = compensated(shop);
    CHECK(result.counts.inserted_blocks > 0);
  }
}

TEST_CASE("the surface of a Klartext cycle goes along with its holes, and nowhere else") {
  // Without Q204 the holes are held.
  const auto program = [](const char* z, const char* surface, const char* clearance = "") {
    return fmt::format(
        "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S1000\n2 L X+0 Y+0 Z{} R0 FMAX\n3 CYCL DEF 200 Q200=2 Q201=-5 "
        "Q203={}{}\n"
        "4 L X+10 Y+5 FMAX M99\n5 L X+20 FMAX M99\n6 END PGM A MM\n",
        z, surface, clearance);
  };
  const Shop shop({.machine = rigid_gantry("0, 0, 0.01"), .text = program("+10", "+0")});
  const auto refused = [&](const std::string& changed) {
    const auto failure = verify(shop.job(), read_program(changed, "changed.h", {}), false).failure;
    return failure ? failure->what : "";
  };
  CHECK(refused(program("+9.990", "-0.010")).empty());
  CHECK(refused(program("+9.990", "-0.110")).find("surface of this hole's cycle") != std::string::npos);
  CHECK(refused(program("+9.990", "+0")).find("surface of this hole's cycle") != std::string::npos);
}

TEST_CASE(
    "a Klartext cycle that is defined again before a hole is accepted only where nothing else changes by "
    "it") {
  const auto program = [](const char* between, const char* again) {
    const std::string definition = "CYCL DEF 200 Q200=2 Q201=-5 Q203=+0 Q204=10\n";
    return "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nL X+0 Y+0 Z+50 R0 FMAX\n" + definition +
           "L X+10 Y+5 FMAX M99\n" + between + (*again ? definition : "") + "L X+20 FMAX M99\nEND PGM A MM\n";
  };
  const auto refused = [&](const char* between) {
    const Shop shop({.machine = rigid_gantry("0, 0, 0"), .text = program(between, "")});
    return verify(shop.job(), read_program(program(between, "again"), "changed.h", {}), false)
        .failure.has_value();
  };
  CHECK_FALSE(refused(""));
  CHECK_FALSE(refused("; the next\n"));
  CHECK(refused("Q201 = -20\n"));
}

namespace {

/// What refuses `changed` as the corrected form of the Klartext program `original`; empty: it is accepted.
std::string klartext_refusal(const std::string& original, const std::string& changed) {
  const Shop shop({.machine = rigid_gantry("0, 0, 0"), .text = original});
  const auto failure = verify(shop.job(), read_program(changed, "changed.h", {}), false).failure;
  return failure ? failure->what : "";
}

/// `text` with the last `what` in the place of which `by` is.
std::string with(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.rfind(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

constexpr const char* words_differ = "the words besides coordinates are not those of the original's block";

}  // namespace

TEST_CASE("a surface of Klartext that no judged hole has stays as it is, and so does its definition") {
  const std::string pocket = "CYCL DEF 252 Q223=30 Q201=-5 Q203=-10 Q204=50\n";
  const std::string original = "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nQ203 = +0\nL X+0 Y+0 Z+50 R0 FMAX\n" +
                               pocket + "L X+10 Y+5 FMAX M99\n" + with(pocket, "-10", "+0") +
                               "L X+20 FMAX M99\nEND PGM A MM\n";
  CHECK(klartext_refusal(original, original).empty());
  for (const auto& [what, by] : {std::pair("Q203=-10", "Q203=-40"), std::pair("Q203=+0", "Q203=-1"),
                                 std::pair("Q203 = +0", "Q203 = -30")}) {
    CAPTURE(what);
    CHECK(klartext_refusal(original, with(original, what, by)).find("this line differs") !=
          std::string::npos);
  }
  CHECK_FALSE(klartext_refusal(original, with(original, with(pocket, "-10", "+0"), "")).empty());
}

TEST_CASE("blocks of Klartext that are not followed keep their CC, polar words, sense and kind of path") {
  const std::string original =
      "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S1000 F600\n2 L Z+0 M91 FMAX\n3 CC X+50 Y+50\n4 LP PR+Q1 PA+45 "
      "FMAX\n"
      "5 CP PA+Q3 DR-\n6 CC X+55 Y+50\n7 C X+Q4 Y+20 DR-\n8 CR X+Q4 Y+20 R+15 DR-\n9 L X+0 Y+0 Z+20 FMAX\n"
      "10 END PGM A MM\n";
  CHECK(klartext_refusal(original, original).empty());
  for (const auto& [what, by] :
       {std::pair("CC X+50", "CC X+90"), std::pair("CC X+55", "CC X+54"), std::pair("PA+45", "PA+90"),
        std::pair("PR+Q1", "PR+Q2"), std::pair("LP PR", "L PR"), std::pair("PA+Q3 DR-", "PA+Q3 DR+"),
        std::pair("Y+20 DR-", "Y+20 DR+"), std::pair("R+15 DR-", "R+15 DR+"), std::pair("C X+Q4", "CR X+Q4"),
        std::pair("3 CC X+50 Y+50\n", "")}) {
    CAPTURE(what);
    CHECK(klartext_refusal(original, with(original, what, by)) == words_differ);
  }
}

TEST_CASE("an arc that is not followed keeps its sense, also where an earlier block gives it") {
  const auto program = [](const std::string& arcs) {
    return "G21 G90 G17 G54\nG0 X0 Y0 Z0\nG1 X0 Y0 F100\n" + arcs + "M30\n";
  };
  const auto refused = [&](const std::string& arcs, const std::string& original) {
    const std::string text = refusal(program(arcs), program(original));
    return text.substr(std::min(text.find(": "), text.size()));
  };
  const std::string stated = "G2 X#102 Y15 I5\n", modal = "G2 X#102 Y15 I5\nX#103 Y20 I5\n";
  const std::string differs = std::string(": ") + words_differ;
  CHECK(refused(stated, stated).empty());
  CHECK(refused("G3 X#102 Y15 I5\n", stated) == differs);
  CHECK(refused(with(modal, "X#103", "G2 X#103"), modal).empty());
  CHECK(refused(with(modal, "X#103", "G3 X#103"), modal) == differs);
  // Behind chords the arc has to be stated again.
  const std::string arc = "G2 X1 Y1 I1 J0\n",
                    chords = "G1 X0.0761 Y0.3827\nX0.2929 Y0.7071\nX0.6173 Y0.9239\nX1 Y1\n",
                    behind = "(next)\nX#102 Y15 I5\n";
  CHECK(refused(chords + with(behind, "X", "G2 X"), arc + behind) == refused(chords, arc));
  CHECK(refused(chords + with(behind, "X", "G3 X"), arc + behind) == differs);
}
