#include <doctest/doctest.h>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/program/read_program.hpp"
#include "counterflex/report/statistics.hpp"

using namespace counterflex;

namespace {

/// Ten moves of 100 mm in all.
FeedMoves ten_moves() {
  FeedMoves moves;
  moves.count = moves.within = 10;
  moves.length_mm = moves.within_mm = 100;
  moves.worst_mm = 0.002;
  moves.worst_line = 7;
  return moves;
}

FeedMoves half_missed() {
  FeedMoves moves = ten_moves();
  moves.within = 5;
  moves.missed = 5;
  moves.within_mm = 54;
  moves.worst_mm = 0.0095;
  return moves;
}

FeedMoves some_unknown() {
  FeedMoves moves = ten_moves();
  moves.count = 22;
  moves.unknown = moves.unknown_length = 12;
  return moves;
}

/// A program of one window on a machine that controls x, y and z.
struct Reading {
  explicit Reading(const char* text) : program(read_program(text, "p.nc", {})) {
    model.mechanism.controlled = {Component::x, Component::y, Component::z};
    tally.add_window(job);
  }
  Program program;
  Model model;
  Toolpath path = build_toolpath(program, one_frame(program, {}));
  ForceSource source;
  PathForces forces{source, program, path, {Matrix3::Identity()}};
  Job job{model, program, path, forces, {}, {}};
  FeedTally tally;

  /// A waypoint of `segment`, or of no segment, that misses by `miss_mm`.
  void solve(std::size_t segment, int line, double miss_mm, bool cutting = true) {
    Waypoint w;
    w.segment = segment;
    w.line = line;
    w.cutting = cutting;
    const auto is_it = [&](const Move& move) { return move.line == line; };
    w.move = static_cast<std::uint32_t>(std::ranges::find_if(program.moves, is_it) - program.moves.begin());
    tally.add(w, miss_mm * mm, job);
  }
};

}  // namespace

TEST_CASE("a verdict is OK only if every feed move is known to be within the tolerance") {
  CHECK(verdict_of(ten_moves()) == Verdict::ok);
  CHECK(verdict_of(half_missed()) == Verdict::partly);
  CHECK(verdict_of(some_unknown()) == Verdict::partly);
}

TEST_CASE("the verdict is NOTHING CORRECTED without known feed moves or without moves") {
  FeedMoves moves;
  CHECK(verdict_of(moves) == Verdict::nothing_corrected);
  moves.count = moves.unknown = moves.unknown_length = 4684;
  CHECK(verdict_of(moves) == Verdict::nothing_corrected);
  moves.rapid_ends = 3;
  CHECK(verdict_of(moves) == Verdict::nothing_corrected);
  moves.known_ends = 1;
  CHECK(verdict_of(moves) == Verdict::partly);
}

TEST_CASE("a program of rapids is OK if their ends were corrected") {
  FeedMoves moves;
  moves.rapid_ends = 3;
  CHECK(verdict_of(moves) == Verdict::ok);
}

TEST_CASE("the reason of PARTLY names share, worst deviation and unknown moves") {
  CHECK(partly_reason(half_missed(), 0.005) == "54 % of the cutting length, worst 0.0095 mm > 0.005");
  CHECK(partly_reason(some_unknown(), 0.005) ==
        "100 % of the known cutting length, 12 feed moves of unknown length");
  FeedMoves unsolved = ten_moves();
  unsolved.count = 11;
  unsolved.unknown = 1;
  unsolved.length_mm = 200;
  CHECK(partly_reason(unsolved, 0.005) == "50 % of the cutting length, 1 feed move of unknown deviation");
  CHECK(verdict_text(Verdict::partly, "50 %") == "PARTLY (50 %)");
  CHECK(verdict_text(Verdict::nothing_corrected, "no move") == "NOTHING CORRECTED");
}

TEST_CASE("a share and a deviation are never rounded to a passing value") {
  FeedMoves moves = half_missed();
  moves.within_mm = 99.999;
  moves.worst_mm = 0.00500004;
  CHECK(partly_reason(moves, 0.005) == "99.9 % of the cutting length, worst 0.00500004 mm > 0.005");
  moves.within_mm = 0.001;
  moves.worst_mm = 0.00501;
  CHECK(partly_reason(moves, 0.005) == "less than 0.1 % of the cutting length, worst 0.00501 mm > 0.005");
  moves.within_mm = 0;
  CHECK(partly_reason(moves, 0.005).starts_with("0 % of the cutting length"));
}

TEST_CASE("feed moves to positions that are variables have no known length") {
  Reading run("G21 G90 G54 G0 X0 Y0 Z0\nG1 X10 F100\nG1 X#1\nY#2\nG0 X#3\n");
  run.solve(0, 2, 0.001);
  const FeedMoves moves = run.tally.moves();
  CHECK(moves.count == 3);
  CHECK(moves.within == 1);
  CHECK(moves.unknown == 2);
  CHECK(moves.unknown_length == 2);
  CHECK(moves.length_mm == doctest::Approx(10));
}

TEST_CASE("a position at which a modal macro is called counts as a move of unknown length") {
  Reading run("O1\nG21 G90 G54 G0 X0. Y0. Z5.\nG66 P9100 Z-5.\nX10.\nY#2\nG67\nG0 X0. Y0. Z5.\nM30\n");
  const FeedMoves moves = run.tally.moves();
  CHECK(moves.count == 2);
  CHECK(moves.unknown_length == 2);
}

TEST_CASE("the noise of the arithmetic does not decide whether a miss is within the tolerance") {
  Reading run("G21 G90\nG0 X0 Y0 Z0\nG1 X10 F100\nX20\n");
  run.solve(1, 3, 0.005 * (1 + 1e-9));
  CHECK(run.tally.moves().missed == 0);
  run.solve(2, 4, 0.005 * (1 + 1e-5));
  CHECK(run.tally.moves().missed == 1);
}

TEST_CASE("a move that misses the tolerance at one place counts once, and as missed") {
  Reading run("G21 G90 G54 G0 X0 Y0 Z0\nG1 X10 F100\nX30\nX60\n");
  for (const double miss_mm : {0.001, 0.006, 0.007}) run.solve(0, 2, miss_mm);
  for (const double miss_mm : {0.009, 0.001}) run.solve(1, 3, miss_mm);
  const FeedMoves moves = run.tally.moves();
  CHECK(moves.missed == 2);
  CHECK(moves.within == 0);
  CHECK(moves.unknown == 1);
  CHECK(moves.unknown_length == 0);
  CHECK(moves.worst_mm == doctest::Approx(0.009));
  CHECK(moves.worst_line == 3);
  CHECK(moves.length_mm == doctest::Approx(60));
}

TEST_CASE("holes count as moves, and have no cutting length") {
  Reading run("G21 G90 G54 G0 X0 Y0 Z5\nG99 G81 X10 Y0 Z-8 R2 F100\nX20\nG80\n");
  run.solve(no_segment, 2, 0.001, false);
  run.solve(no_segment, 3, 0.02, false);
  const FeedMoves moves = run.tally.moves();
  CHECK(moves.count == 2);
  CHECK(moves.within == 1);
  CHECK(moves.missed == 1);
  CHECK(moves.unknown == 0);
  CHECK(moves.length_mm == 0);
  CHECK(verdict_of(moves) == Verdict::partly);
  CHECK(partly_reason(moves, 0.005) ==
        "1 of 2 feed moves, 1 feed move above the tolerance, worst 0.0200 mm > 0.005");
}

TEST_CASE("a call that is not expanded is a feed move of unknown length") {
  Reading run("G21 G90 G54 G0 X0 Y0 Z5\nG1 Z0 F100\nM98 P100\n");
  run.solve(0, 2, 0.001);
  CHECK(run.tally.moves().count == 2);
  CHECK(run.tally.moves().unknown_length == 1);
}

TEST_CASE("feeds of further axes, to joint values and to a hole are feed moves of unknown length") {
  const std::string
      klartext = "BEGIN PGM A MM\nTOOL CALL 1 Z S100\nL X+0 Y+0 Z+5 R0 FMAX\nL Z+0 F100\n",
      drilling = "CYCL DEF 200 DRILLING Q200=2 Q201=-5 Q206=150 Q202=5 Q210=0 Q203=+0 Q204=50 Q211=0\n",
      gcode = "G21 G90 G54 G0 X0 Y0 Z5\nG1 Z0 F100\n",
      siemens = "G71 G90 G17 G54\nG0 X0 Y0 Z5\nG1 Z0 F100\nMCALL CYCLE81(5,0,2,-5)\n";
  const std::string ur = "def a():\n movel(p[0,0,0,0,0,0])\n movel(p[0,0,1,0,0,0])\n";
  const auto unknown_in = [](const std::string& text) {
    return Reading(text.c_str()).tally.moves().unknown_length;
  };
  CHECK(unknown_in(gcode) == 0);
  CHECK(unknown_in(gcode + "A360 F500\n") == 1);
  CHECK(unknown_in(gcode + "A360\nA0\n") == 2);
  CHECK(unknown_in(gcode + "A0\n") == 0);
  CHECK(unknown_in(gcode + "G0 A90\n") == 0);
  CHECK(unknown_in(gcode + "G53 G1 A5\n") == 1);
  CHECK(unknown_in(gcode + "G28 A5\nG30 A5\n") == 0);
  const std::string end = "END PGM A MM\n";
  CHECK(unknown_in(klartext + "L C+90 F500\n" + end) == 1);
  CHECK(unknown_in(klartext + "L IA+90 F500\n" + end) == 1);
  CHECK(unknown_in(klartext + "L C+90 FMAX\n" + end) == 0);
  CHECK(unknown_in(klartext + drilling + "L X+40 Y+40 F300 M99\n" + end) == 1);
  CHECK(unknown_in(klartext + drilling + "L X+40 Y+40 FMAX M99\n" + end) == 0);
  CHECK(unknown_in(siemens + "G1 X40 Y40 F300\nMCALL\nM30\n") == 1);
  CHECK(unknown_in(klartext + "L Z+2 F100\n" + drilling + "L X+40 Y+40 F300 M99\n" + end) == 0);
  CHECK(
      unknown_in("G71 G90 G17 G54\nG0 X0 Y0 Z5\nG1 Z2 F100\nMCALL CYCLE81(5,0,2,-5)\nG1 X40 Y40 F300\nMCALL\n"
                 "M30\n") == 0);
  CHECK(unknown_in(siemens + "G0 X40 Y40\nMCALL\nM30\n") == 0);
  CHECK(unknown_in(ur + "end\n") == 1);  // the first
  CHECK(unknown_in(ur + " movel([0,-1.7,-1.9,-1,1.57,0], a=0.5, v=0.02)\nend\n") == 2);
}

TEST_CASE("a feed move from an unknown position is unknown, but its end is corrected") {
  Reading run("G21 G90 G54 G1 X0 Y0 Z5 F100\n");
  run.solve(no_segment, 1, 0.001, false);
  const FeedMoves moves = run.tally.moves();
  CHECK(moves.known_ends == 1);
  CHECK(moves.unknown_length == 1);
  CHECK(verdict_of(moves) == Verdict::partly);
}

TEST_CASE("a move that only turns the tool counts, and does not make up for one that is unknown") {
  Reading run(
      "DEF part( )\nPTP {X 600,Y 0,Z 500,A 0,B 0,C 180}\nLIN {X 650,Y 0,Z 500,A 0,B 0,C 180}\n"
      "LIN {X 650,Y 0,Z 500,A 3,B 0,C 180}\npocket()\nEND\n");
  run.solve(0, 3, 0.001);
  run.solve(1, 4, 0.001);
  const FeedMoves moves = run.tally.moves();
  CHECK(moves.count == 3);
  CHECK(moves.within == 2);
  CHECK(moves.unknown == 1);
  CHECK(moves.unknown_length == 1);
  CHECK(verdict_of(moves) == Verdict::partly);
}

TEST_CASE("a hole that is measured twice does not make up for one that is unknown") {
  Reading run("G21 G90 G54 G0 X0 Y0 Z5\nG99 G81 X10 Y0 Z-8 R2 F100\nX20\nG80\n");
  run.solve(no_segment, 2, 0.001, false);
  run.solve(no_segment, 2, 0.001, false);
  CHECK(run.tally.moves().unknown == 1);
}

TEST_CASE("a feed move without length does not count") {
  Reading run("G21 G90 G54 G0 X0 Y0 Z5\nG1 X0 F100\nX10\n");
  run.solve(0, 3, 0.001);
  CHECK(run.tally.moves().count == 1);
  CHECK(run.tally.moves().unknown == 0);
}
