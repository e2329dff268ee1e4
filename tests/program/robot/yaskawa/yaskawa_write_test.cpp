// Jobs of Yaskawa robots: writing of corrected positions.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "counterflex/program/program_reader.hpp"
#include "program/robot/yaskawa/yaskawa.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string home_and_cut =
    "MOVJ C00000 VJ=50.00\nMOVJ C00001 VJ=25.00\n\tMOVL C00002 V=66.7 PL=0 'down\n"
    "MOVL C00003 V=10.0 PL=1 ACC=50\nMOVJ C00000 VJ=50.00\n";

std::string written(const Program& program, const std::vector<MoveEdit>& edits) {
  return rewrite(program, edits, {}).text;
}

}  // namespace

TEST_CASE("a Yaskawa job whose positions do not change keeps every byte") {
  std::string text = job_of(jbi_positions_text + "P00100 = +.5,2,-0.0,0.00,0.00,0.00\n",
                            home_and_cut + "MOVL P100 V=1\nMOVL P00100 V=2\n'\x83\x5C \"\nDOUT OT#(1) ON\n");
  CHECK(unchanged(read_job(text)) == text);
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, "\r");
  CHECK(unchanged(read_job(text)) == text);
}

TEST_CASE("corrected numbers take the place of those of the position") {
  const Program program = read_steps(home_and_cut);
  auto edits = robot_edits(program);
  edits[1].end_mm = {0.0124, -0.02, 0.1};
  (*edits[2].orientation)[2] = 10.01234;
  const Rewritten out = rewrite(program, edits, {});
  CHECK(out.changed_words == 4);
  std::string expected = program.text;
  const auto put = [&](const std::string& from, const std::string& to) {
    expected.replace(expected.find(from), from.size(), to);
  };
  put("C00002=0.000,0.000,0.000", "C00002=0.012,-0.020,0.100");
  put("180.0000,0.0000,10.0000", "180.0000,0.0000,10.0123");
  CHECK(out.text == expected);
}

TEST_CASE("an inserted step gets a position before that of its step, and the numbers behind it count on") {
  const Program program = read_steps(home_and_cut);
  auto edits = robot_edits(program);
  edits[2].inserted = {{{30, 0.05, 0}, {}, OrientationNumbers{180, 0, 3, 0}},
                       {{60, 0.05, 0}, {}, OrientationNumbers{180, 0, 6, 0}}};
  const Rewritten out = rewrite(program, edits, {});
  CHECK(out.inserted_blocks == 2);
  CHECK(out.text.find("///NPOS 6,0,0,0,0,0\n") != std::string::npos);
  CHECK(positions_in(out.text) ==
        "C00000=390876,202089,35618,0,-117424,182917\n///POSTYPE USER\n///RECTAN\n///RCONF 1,0,0,0,0,0\n"
        "C00001=0.000,0.000,50.000,180.0000,0.0000,0.0000\n"
        "C00002=0.000,0.000,0.000,180.0000,0.0000,0.0000\n"
        "C00003=30.000,0.050,0.000,180.0000,0.0000,3.0000\n"
        "C00004=60.000,0.050,0.000,180.0000,0.0000,6.0000\n"
        "C00005=100.000,0.000,0.000,180.0000,0.0000,10.0000\n");
  CHECK(instructions_in(out.text) ==
        "MOVJ C00000 VJ=50.00\nMOVJ C00001 VJ=25.00\n\tMOVL C00002 V=66.7 PL=0 'down\n"
        "MOVL C00003 V=10.0 PL=1 ACC=50\nMOVL C00004 V=10.0 PL=1 ACC=50\n"
        "MOVL C00005 V=10.0 PL=1 ACC=50\nMOVJ C00000 VJ=50.00\n");
  const Program read_back = read_job(out.text);
  REQUIRE(read_back.moves.size() == 5);
  CHECK(read_back.moves[4].end_mm == Vector3(100, 0, 0));
}

TEST_CASE("numbers with gaps stay, and new positions are numbered behind them") {
  const std::string positions =
      "///POSTYPE BASE\n///RECTAN\nC010=0.000,0.000,0.000,0.00,0.00,0.00\n"
      "C020=10.000,0.000,0.000,0.00,0.00,0.00\nC030=20.000,0.000,0.000,0.00,0.00,0.00\n";
  const Program program =
      read_job(job_of(positions, "MOVL C010 V=1\nMOVL C020 V=1\nMOVL C030 V=1\nREFP 1 C020\n", 3));
  auto edits = robot_edits(program);
  edits[2].inserted = {{{15, 0.1, 0}, {}, edits[2].orientation}};
  const std::string text = written(program, edits);
  CHECK(text.find("C020=10.000,0.000,0.000,0.00,0.00,0.00\nC031=15.000,0.100,0.000,0.00,0.00,0.00\nC030=") !=
        std::string::npos);
  CHECK(instructions_in(text) == "MOVL C010 V=1\nMOVL C020 V=1\nMOVL C031 V=1\nMOVL C030 V=1\nREFP 1 C020\n");
}

TEST_CASE("copies of a step with a rail have positions of the rail, too") {
  const std::string positions =
      "///POSTYPE BASE\n///RECTAN\nC00000=0.000,0.000,0.000,0.0000,0.0000,0.0000\n"
      "C00001=10.000,0.000,0.000,0.0000,0.0000,0.0000\n///POSTYPE PULSE\n///PULSE\nBC00000=7\nBC00001=7\n";
  std::string text = job_of(positions, "MOVL C00000 BC00000 V=1\nMOVL C00001 BC00001 V=1\n", 2);
  text.replace(text.find("2,0,0,0,0,0"), 3, "2,2");
  const Program program = read_job(text);
  auto edits = robot_edits(program);
  REQUIRE(program.moves[1].may_split);
  edits[1].inserted = {{{5, 0.1, 0}, {}, edits[1].orientation}};
  const std::string out = written(program, edits);
  CHECK(out.find("///NPOS 3,3,0,0,0,0\n") != std::string::npos);
  CHECK(out.find("BC00000=7\nBC00001=7\nBC00002=7\n") != std::string::npos);
  CHECK(instructions_in(out) ==
        "MOVL C00000 BC00000 V=1\nMOVL C00001 BC00001 V=1\nMOVL C00002 BC00002 V=1\n");
}

TEST_CASE("a position of several steps gets another one where their corrections differ") {
  const Program program =
      read_steps("MOVJ C00001 VJ=25.00\nMOVL C00002 V=10\nMOVL C00003 V=10\nMOVL C00002 V=10\n");
  auto edits = robot_edits(program);
  edits[1].end_mm.x() = edits[3].end_mm.x() = 0.1;
  std::string text = written(program, edits);
  CHECK(text.find("C00002=0.100,0.000,0.000,180.0000,0.0000,0.0000\nC00003=100.") != std::string::npos);
  CHECK(instructions_in(text) == instructions_in(program.text));
  edits[3].end_mm.x() = 0.2;
  text = written(program, edits);
  CHECK(text.find("C00002=0.200,0.000,0.000,180.0000,0.0000,0.0000\n"
                  "C00003=0.100,0.000,0.000,180.0000,0.0000,0.0000\nC00004=100.") != std::string::npos);
  CHECK(instructions_in(text) ==
        "MOVJ C00001 VJ=25.00\nMOVL C00003 V=10\nMOVL C00004 V=10\nMOVL C00002 V=10\n");
  edits[1].end_mm.x() = 0;
  text = written(program, edits);
  CHECK(instructions_in(text) ==
        "MOVJ C00001 VJ=25.00\nMOVL C00003 V=10\nMOVL C00004 V=10\nMOVL C00002 V=10\n");
}

TEST_CASE("a position variable is changed in its place only if nothing else uses it") {
  const std::string positions = jbi_positions_text + "P00100=5.000,0.000,0.000,180.0000,0.0000,0.0000\n";
  const auto corrected = [&](const std::string& other) {
    const Program program = read_job(job_of(positions, "MOVL P100 V=10\n" + other));
    auto edits = robot_edits(program);
    edits[0].end_mm.x() = 5.1;
    return written(program, edits);
  };
  std::string text = corrected("");
  CHECK(text.find("P00100=5.100,") != std::string::npos);
  CHECK(instructions_in(text) == "MOVL P100 V=10\n");
  for (const std::string other : {"SET LP000 P100\n", "MOVL P00100 V=20\n", "SET LP000 P[I000]\n"}) {
    CAPTURE(other);
    text = corrected(other);
    CHECK(text.find("C00004=5.100,0.000,0.000,180.0000,0.0000,0.0000\n"
                    "P00100=5.000,0.000,0.000,180.0000,0.0000,0.0000\n") != std::string::npos);
    CHECK(text.find("///NPOS 5,0,0,0,0,0\n") != std::string::npos);
    CHECK(instructions_in(text) == "MOVL C00004 V=10\n" + other);
  }
}

TEST_CASE("a corrected circle keeps its three steps") {
  const Program program = read_job(job_of(
      "///POSTYPE BASE\n///RECTAN\nC00000=10.000,0.000,0.000,180.0000,0.0000,0.0000\n"
      "C00001=20.000,10.000,0.000,180.0000,0.0000,0.0000\nC00002=30.000,0.000,0.000,180.0000,0.0000,0.0000\n",
      "MOVC C00000 V=10\nMOVC C00001 V=10\nMOVC C00002 V=10\n", 3));
  REQUIRE(program.moves.size() == 2);
  auto edits = robot_edits(program);
  for (MoveEdit& edit : edits) {
    edit.end_mm.z() = 0.1;
    (*edit.orientation)[0] = 180.01;
  }
  edits[1].centre_mm = Vector3(20, 0, 0.1);
  CHECK(positions_in(written(program, edits)) ==
        "C00000=10.000,0.000,0.100,180.0100,0.0000,0.0000\n"
        "C00001=20.000,10.000,0.100,180.0100,0.0000,0.0000\n"
        "C00002=30.000,0.000,0.100,180.0100,0.0000,0.0000\n");
}

TEST_CASE("a corner radius beside inserted steps reaches to the middle between them") {
  const Program program = read_steps("MOVL C00002 V=10\nMOVL C00003 V=10 CR=25.0\n");
  auto edits = robot_edits(program);
  edits[1].inserted = {{{90, 0.1, 0}, {}, edits[1].orientation}};
  CHECK(instructions_in(written(program, edits)) ==
        "MOVL C00002 V=10\nMOVL C00003 V=10 CR=5.0\nMOVL C00004 V=10 CR=5.0\n");
}

TEST_CASE("the header of a corrected job is behind NOP and is recognised behind many positions") {
  std::string positions = "///POSTYPE BASE\n///RECTAN\n";
  for (int i = 0; i < 200; ++i)
    positions += fmt::format("C{:05}={}.000,0.000,0.000,0.0000,0.0000,0.0000\n", i, i);
  const Program program = read_job(job_of(positions, "MOVL C00000 V=10\n", 200));
  CHECK(!is_corrected(program));
  const std::string text = rewrite(program, {}, {.header = {"COUNTERFLEX 1 TEST"}}).text;
  CHECK(instructions_in(text) == "' COUNTERFLEX 1 TEST\nMOVL C00000 V=10\n");
  CHECK(is_corrected(read_job(text)));
}

TEST_CASE("lines of positions that moves judge are no lines of their own, and other numbers are counts") {
  const Program program = read_steps(home_and_cut);
  std::vector<std::string> counts;
  for (const Span span : program.counts)
    counts.push_back(program.text.substr(span.begin, span.end - span.begin));
  CHECK(counts == std::vector<std::string>{"4", "0", "0", "00000",
                                           "C00001=0.000,0.000,50.000,180.0000,0.0000,0.0000",
                                           "C00002=0.000,0.000,0.000,180.0000,0.0000,0.0000",
                                           "C00003=100.000,0.000,0.000,180.0000,0.0000,10.0000", "00000",
                                           "00001", "00002", "00003", "00000"});
}

TEST_CASE("the line of a position that another instruction uses stays, and is compared") {
  const std::string other = "REFP 1 C00003\nIFTHENEXP B000=0\nMOVL C00002 V=10\nENDIF\n";
  const Program program = read_steps("MOVL C00002 V=10\nMOVL C00003 V=10\n" + other);
  for (const Span span : program.counts) CHECK(span.end - span.begin <= 5);  // no whole line
  auto edits = robot_edits(program);
  edits[0].end_mm.x() = edits[1].end_mm.x() = 0.1;
  const std::string text = written(program, edits);
  CHECK(text.find("C00002=0.100,0.000,0.000,180.0000,0.0000,0.0000\n"
                  "C00003=0.000,0.000,0.000,180.0000,0.0000,0.0000\n"
                  "C00004=0.100,0.000,0.000,180.0000,0.0000,10.0000\n"
                  "C00005=100.000,0.000,0.000,180.0000,0.0000,10.0000\n") != std::string::npos);
  CHECK(instructions_in(text) ==
        "MOVL C00002 V=10\nMOVL C00004 V=10\nREFP 1 C00005\nIFTHENEXP B000=0\nMOVL C00003 V=10\nENDIF\n");
}
