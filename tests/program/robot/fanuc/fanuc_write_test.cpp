// Programs of FANUC robots: writing of corrected positions.
#include <doctest/doctest.h>

#include "counterflex/program/kept_words.hpp"
#include "counterflex/program/size_limit.hpp"
#include "program/robot/fanuc/fanuc.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string tp_job =
    "  UFRAME_NUM=1 ;\n"
    "J P[1] 50% FINE    ;\n"
    "L P[2] 20mm/sec CNT100    ;\n"
    "L P[3] 20mm/sec CNT100 ACC80    ;\n"
    "  R[1]=P[4,1]    ;\n"
    "L P[2] 20mm/sec CNT100    ;\n";

/// The text text_between `begin` and `end`.
std::string text_between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t at = text.find(begin);
  return at == std::string::npos ? "" : text.substr(at, text.find(end, at) - at);
}

std::string tp_statements_of(const std::string& text) {
  return text_between(text, "/MN\n", "/POS\n");
}

std::string tp_position_of(const std::string& text, int number) {
  return text_between(text, "\nP[" + std::to_string(number) + "]{", "};\n");
}

}  // namespace

TEST_CASE("a program whose targets do not change keeps every byte") {
  const std::string text = tp_program(tp_job, tp_square());
  CHECK(unchanged(read_tp(text)) == text);
  std::string other = tp_program("C P[2]\n:  P[3] 9mm/sec CNT5 ;\n!\xb0\xa1 \xe9 ;\n", tp_square());
  for (std::size_t at = 0; (at = other.find('\n', at)) != std::string::npos; at += 2) other.insert(at, "\r");
  other.erase(other.size() - 2);  // no line end at the end
  CHECK(unchanged(read_tp(other)) == other);
}

TEST_CASE("numbers change in their places and columns") {
  const Program program = read_tp(tp_program(tp_job, tp_square()));
  std::vector<MoveEdit> edits = robot_edits(program);
  edits[2].end_mm += Vector3(0.0124, -0.3, 0);
  edits[2].orientation = OrientationNumbers{179.98, 0.00003, -10.5};
  const Rewritten out = rewrite(program, edits, {});
  CHECK(out.changed_words == 4);
  CHECK(tp_position_of(out.text, 3) ==
        "\nP[3]{\n   GP1:\n\tUF : 1, UT : 2,\t\tCONFIG : 'N U T, 0, 0, 0',\n"
        "\tX =   100.012  mm,\tY =    -0.300  mm,\tZ =     0.000  mm,\n"
        "\tW =   179.980 deg,\tP =     0.000 deg,\tR =   -10.500 deg\n");
  CHECK(tp_statements_of(out.text) == tp_statements_of(program.text));
}

TEST_CASE("a position of several motions is changed in its place if all need the same numbers") {
  const Program program = read_tp(tp_program(tp_job, tp_square()));
  std::vector<MoveEdit> edits = robot_edits(program);
  edits[1].end_mm.x() += 0.5;
  edits[3].end_mm.x() += 0.5;
  const std::string text = rewrite(program, edits, {}).text;
  CHECK(tp_statements_of(text) == tp_statements_of(program.text));
  CHECK(tp_position_of(text, 2).find("X =     0.500  mm") != std::string::npos);
  CHECK(text.find("P[5]") == std::string::npos);
}

TEST_CASE("motions that need other numbers of a position get a new position behind the others") {
  const Program program = read_tp(tp_program(tp_job, tp_square()));
  std::vector<MoveEdit> edits = robot_edits(program);
  edits[1].end_mm.x() += 0.5;
  edits[3].end_mm.x() += 0.25;
  std::string text = rewrite(program, edits, {}).text;
  CHECK(tp_position_of(text, 2).find("X =     0.500  mm") != std::string::npos);
  CHECK(tp_position_of(text, 5).find("X =     0.250  mm") != std::string::npos);
  CHECK(text.find("   6:L P[5] 20mm/sec CNT100    ;\n") != std::string::npos);
  CHECK(text.ends_with("};\n/END\n"));
  edits[1].end_mm.x() -= 0.5;  // the unchanged one keeps the position
  text = rewrite(program, edits, {}).text;
  CHECK(tp_position_of(text, 2) == tp_position_of(program.text, 2));
  CHECK(tp_position_of(text, 5).find("X =     0.250  mm") != std::string::npos);
}

TEST_CASE("a position that another statement uses stays") {
  const Program program = read_tp_statements("L P[1] 9mm/sec FINE ;\nL P[3] 9mm/sec FINE ;\nPR[1]=P[3] ;\n");
  std::vector<MoveEdit> edits = robot_edits(program);
  for (MoveEdit& edit : edits) edit.end_mm.y() += 0.125;
  const std::string text = rewrite(program, edits, {}).text;
  CHECK(tp_position_of(text, 3) == tp_position_of(program.text, 3));
  CHECK(tp_position_of(text, 1).find("Y =     0.125  mm") != std::string::npos);
  CHECK(tp_position_of(text, 5).find("Y =     0.125  mm") != std::string::npos);
  CHECK(text.find("   2:L P[5] 9mm/sec FINE ;\n   3:PR[1]=P[3] ;\n") != std::string::npos);
}

TEST_CASE("an inserted point is a copy of the statement with a position of its own") {
  const Program program = read_tp(tp_program(tp_job, tp_square()));
  std::vector<MoveEdit> edits = robot_edits(program);
  edits[2].inserted = {{{25, 0, 0.5}, {}, OrientationNumbers{180, 0, 2.5}},
                       {{50, 0, 0.75}, {}, OrientationNumbers{180, 0, 5}}};
  const Rewritten out = rewrite(program, edits, {});
  CHECK(out.inserted_blocks == 2);
  CHECK(
      tp_statements_of(out.text) ==
      "/MN\n   1:  UFRAME_NUM=1 ;\n   2:J P[1] 50% FINE    ;\n   3:L P[2] 20mm/sec CNT100    ;\n"
      "   4:L P[5] 20mm/sec CNT100 ACC80    ;\n   5:L P[6] 20mm/sec CNT100 ACC80    ;\n"
      "   6:L P[3] 20mm/sec CNT100 ACC80    ;\n   7:  R[1]=P[4,1]    ;\n   8:L P[2] 20mm/sec CNT100    ;\n");
  CHECK(out.text.find("LINE_COUNT\t= 8;\n") != std::string::npos);
  CHECK(tp_position_of(out.text, 6) ==
        "\nP[6]{\n   GP1:\n\tUF : 1, UT : 2,\t\tCONFIG : 'N U T, 0, 0, 0',\n"
        "\tX =    50.000  mm,\tY =     0.000  mm,\tZ =     0.750  mm,\n"
        "\tW =   180.000 deg,\tP =     0.000 deg,\tR =     5.000 deg\n");
  CHECK(tp_position_of(out.text, 3) == tp_position_of(program.text, 3));
  const Program again = read_tp(out.text);
  REQUIRE(again.moves.size() == 6);
  CHECK(again.moves[3].end_mm == Vector3(50, 0, 0.75));
}

TEST_CASE("numbers of lines that are not in order stay, as does a LINE_COUNT that is not the last one") {
  std::string text = tp_program(tp_job, tp_square());
  const auto inserted = [&] {
    const Program program = read_tp(text);
    std::vector<MoveEdit> edits = robot_edits(program);
    edits[2].inserted = {{{25, 0, 0.5}, {}, OrientationNumbers{180, 0, 2.5}}};
    return rewrite(program, edits, {}).text;
  };
  text.replace(text.find("LINE_COUNT\t= 6"), 14, "LINE_COUNT\t= 4");
  CHECK(inserted().find("LINE_COUNT\t= 4;\n") != std::string::npos);
  CHECK(inserted().find("   7:L P[2]") != std::string::npos);
  text.replace(text.find("   6:L"), 6, "   2:L");
  CHECK(inserted().find("   5:  R[1]") != std::string::npos);
  CHECK(inserted().find("   2:L P[2] 20mm/sec CNT100    ;\n/POS") != std::string::npos);
}

TEST_CASE("lines whose numbers have gaps are numbered without gaps where a line is inserted") {
  for (const char* count : {"6", "60"}) {
    std::string text = tp_program(tp_job, tp_square());
    text.replace(text.find("   6:L"), 6, "  60:L");
    text.replace(text.find("LINE_COUNT\t= 6"), 14, std::string("LINE_COUNT\t= ") + count);
    const Program program = read_tp(text);
    CHECK(unchanged(program) == text);
    std::vector<MoveEdit> edits = robot_edits(program);
    edits[2].inserted = {{{25, 0, 0.5}, {}, OrientationNumbers{180, 0, 2.5}}};
    const std::string written = rewrite(program, edits, {}).text;
    CHECK(written.find("   7:L P[2]") != std::string::npos);
    CHECK(written.find("LINE_COUNT\t= 7;\n") != std::string::npos);
  }
}

TEST_CASE("a statement in lower case is written as one in upper case") {
  std::string text = tp_program(tp_job, tp_square());
  text.replace(text.find("L P[2] 20mm/sec"), 15, "l p[2] 20mm/sec");
  const Program program = read_tp(text);
  CHECK(unchanged(program) == text);
  std::vector<MoveEdit> edits = robot_edits(program);
  for (MoveEdit& edit : edits) edit.end_mm.z() += 0.5;
  edits.back().end_mm.z() += 0.5;
  const Program again = read_tp(rewrite(program, edits, {}).text);
  REQUIRE(again.moves.size() == program.moves.size());
  for (std::size_t m = 0; m < edits.size(); ++m) {
    CHECK(again.moves[m].end_mm == edits[m].end_mm);
    CHECK(kept_words(again, again.moves[m]) == kept_words(program, program.moves[m]));
  }
}

TEST_CASE("C is written with its auxiliary point, and as lines without it") {
  const std::string positions = tp_position(1, {0, 0, 0, 0, 0, 0}) + tp_position(2, {10, 10, 0, 0, 0, 0}) +
                                tp_position(3, {20, 0, 0, 0, 0, 0});
  const Program program =
      read_tp_statements("L P[1] 9mm/sec CNT10 ;\nC P[2]    \n:  P[3] 9mm/sec CNT10    ;\n", positions);
  std::vector<MoveEdit> edits = robot_edits(program);
  edits[1].end_mm += Vector3(0, 0, 0.5);
  std::string text = rewrite(program, edits, {}).text;
  CHECK(tp_position_of(text, 3).find("Z =     0.500  mm") != std::string::npos);
  CHECK(read_tp(text).moves[1].arc);
  edits[1].centre_mm.reset();
  edits[1].inserted = {{{10, 10, 0.25}, {}, OrientationNumbers{0, 0, 0}}};
  text = rewrite(program, edits, {}).text;
  CHECK(tp_statements_of(text) ==
        "/MN\n   1:L P[1] 9mm/sec CNT10 ;\n   2:L P[4] 9mm/sec CNT10    ;\n   3:L P[3] 9mm/sec CNT10    ;\n");
}

TEST_CASE("the header is remarks of at most 32 characters, and is recognised") {
  const std::string text = tp_program(tp_job, tp_square());
  const std::vector<std::string> header{"COUNTERFLEX 1 VERSION 1.2 METHOD ELASTOSTATIC",
                                        "COUNTERFLEX 1 PROGRAM 0123456789abcdef0123"};
  const Program program = read_tp(text);
  const std::string out = rewrite(program, robot_edits(program), {.header = header}).text;
  CHECK(tp_statements_of(out).starts_with(
      "/MN\n   1:  !COUNTERFLEX 1 VERSION 1.2 METHOD ;\n   2:  !COUNTERFLEX 1 ELASTOSTATIC ;\n"
      "   3:  !COUNTERFLEX 1 PROGRAM 0123456789 ;\n   4:  UFRAME_NUM=1 ;\n"));
  CHECK(out.find("LINE_COUNT\t= 9;\n") != std::string::npos);
  CHECK(is_corrected(read_tp(out)));
  CHECK(!is_corrected(program));
  CHECK(read_tp(out).operations.size() == program.operations.size());
}

TEST_CASE("a program with more than 999 positions after insertion is refused; one that has more is not") {
  const auto inserted = [](int last, std::optional<std::size_t> most = {}) {
    const Program program =
        read_tp_statements("L P[1] 9mm/sec CNT5 ;\nL P[2] 9mm/sec CNT5 ;\n",
                           tp_position(1, {0, 0, 0, 0, 0, 0}) + tp_position(2, {9, 0, 0, 0, 0, 0}) +
                               tp_position(last, {9, 0, 0, 0, 0, 0}));
    std::vector<MoveEdit> edits = robot_edits(program);
    edits[1].inserted = {{{5, 0, 0.5}, {}, OrientationNumbers{}}};
    const WriteOptions options{.most_points = most.value_or(size_limit("fanuc_tp")->most)};
    const Rewritten out = rewrite(program, edits, options);
    return diagnostic_of([&] { refuse_too_many_points("job.ls", "fanuc_tp", out.points, most); });
  };
  CHECK(inserted(998) == "none");
  CHECK(
      inserted(999) ==
      "job.ls:7:1: error: the corrected program has 1000 positions, but a FANUC TP program has at most 999, "
      "reached here; allow a larger --tolerance-mm, divide it with --max-points 999, or give --max-points "
      "the "
      "limit of a control that allows more");
  CHECK(inserted(999, 1500) == "none");
  CHECK(inserted(1200) == "none");
}

TEST_CASE("the lines of positions that only followed motions use are listed as counts") {
  const Program program = read_tp(tp_program(tp_job, tp_square()));
  std::string listed;
  for (const Span count : program.counts)
    if (count.end - count.begin > 20) listed += program.text.substr(count.begin, 4);
  CHECK(listed == "P[1]P[2]P[3]");  // P[4] is used by R[1]=P[4,1] alone
}
