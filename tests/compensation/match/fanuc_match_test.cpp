// What of a FANUC TP program is compared besides coordinates: statements, positions and the other lines.
#include <doctest/doctest.h>

#include "compensation/match/corrected_moves.hpp"
#include "counterflex/program/kept_words.hpp"
#include "counterflex/program/read_program.hpp"
#include "counterflex/program/rewrite.hpp"

using namespace counterflex;

namespace {

const std::string tp_positions_of_job =
    "P[1]{\n   GP1:\n\tUF : 1, UT : 2,\tCONFIG : 'N U T, 0, 0, 0',\n"
    "\tX =     0.000  mm,\tY =     0.000  mm,\tZ =     5.000  mm,\n"
    "\tW =     0.000 deg,\tP =     0.000 deg,\tR =     0.000 deg\n};\n"
    "P[2:\"A\"]{ GP1: UF : 1, UT : 2, CONFIG : 'N U T, 0, 0, 0', X = 40.0 mm, Y = 0.0 mm, Z = 5.0 mm, W = "
    "0.0 deg, "
    "P = 0.0 deg, R = 0.0 deg };\n"
    "P[3]{ GP1: UF : 1, UT : 2, CONFIG : 'N U T, 0, 0, 0', X = 1.0 mm, Y = 0.0 mm, Z = 5.0 mm, W = 0.0 deg, "
    "P = 0.0 deg, R = 0.0 deg };\n";

const std::string tp_job =
    "/PROG A\n/ATTR\nLINE_COUNT = 4;\n/MN\n   1:L P[1] 9mm/sec CNT50 ;\n   2:L P[2:A] 9mm/sec CNT50    \n    "
    ":  ACC80 ;\n"
    "   3:  DO[1]=ON ;\n   4:L P[1] 9mm/sec CNT50 ;\n/POS\n" +
    tp_positions_of_job + "/END\n";

/// The job with a point in its second motion, and different ends for the two motions to P[1].
std::string corrected_tp_job() {
  const Program program = read_program(tp_job, "a.ls", {});
  std::vector<MoveEdit> edits;
  for (std::size_t m = 0; m < program.moves.size(); ++m)
    edits.push_back({.move = m, .end_mm = program.moves[m].end_mm, .orientation = OrientationNumbers{}});
  edits[0].end_mm.z() += 0.25;
  edits[1].inserted = {{{20, 0, 5.5}, {}, OrientationNumbers{}}};
  edits[2].end_mm.z() += 0.5;
  return rewrite(program, edits, {.header = {"COUNTERFLEX 1 VERSION 1 METHOD ELASTOSTATIC"}}).text;
}

std::vector<std::string> other_lines(const std::string& text) {
  OtherLines lines;
  lines.add(read_program(text, "a.ls", {}));
  std::vector<std::string> texts;
  for (const OtherLine& line : lines.lines) texts.push_back(line.text);
  return texts;
}

std::string replaced_once(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace

TEST_CASE(
    "other lines of a FANUC program are equal after insertion of points, numbers of lines and the header") {
  const std::string corrected = corrected_tp_job();
  CAPTURE(corrected);
  CHECK(corrected.find("P[5]{") != std::string::npos);
  CHECK(other_lines(corrected) == other_lines(tp_job));
  for (const auto& [from, to] : {std::pair{"DO[1]=ON", "DO[2]=ON"}, std::pair{"X = 1.0 mm", "X = 2.0 mm"},
                                 std::pair{"/END", "P[9]{ GP1: J1= 0 deg };\n/END"}})
    CHECK(other_lines(replaced_once(corrected, from, to)) != other_lines(tp_job));
}

TEST_CASE(
    "statements of a FANUC program are alike if only numbers of lines, positions and coordinates differ") {
  const Program original = read_program(tp_job, "a.ls", {});
  const std::string corrected = corrected_tp_job();
  const auto words_of = [](const std::string& text) {
    const Program program = read_program(text, "a.ls", {});
    std::vector<std::string> all;
    for (const Move& move : program.moves) all.push_back(kept_words(program, move));
    return all;
  };
  const std::vector<std::string> found = words_of(corrected);
  REQUIRE(found.size() == 4);
  CHECK(found[0] == kept_words(original, original.moves[0]));
  CHECK(found[1] == kept_words(original, original.moves[1]));
  CHECK(found[2] == kept_words(original, original.moves[1]));
  CHECK(found[3] == kept_words(original, original.moves[2]));
  CHECK(found[0] != found[1]);  // ACC80
  CHECK(words_of(replaced_once(corrected, "'N U T", "'F U T"))[0] != found[0]);
  CHECK(words_of(replaced_once(corrected, "9mm/sec CNT50", "9mm/sec CNT60"))[0] != found[0]);
}
