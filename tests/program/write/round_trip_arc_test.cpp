#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "counterflex/program/rewrite.hpp"
#include "program/reading.hpp"
#include "program/small_reader.hpp"
#include "program/synthetic_arcs.hpp"
#include "support/text.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr int arc_programs = 300;
constexpr int arc_blocks = 60;

/// A smooth correction of about 0.2 mm, almost constant along an arc, so that the arc remains one.
constexpr double little = 0.02;
Vector3 arc_correction(const Vector3& p_mm, double variation = little) {
  return Vector3(0.2, -0.1, 0.05) + variation * Vector3(0.2 * std::sin(p_mm.y() / 30),
                                                        0.1 * std::cos(p_mm.x() / 20),
                                                        0.05 * std::sin(p_mm.x() / 7 + p_mm.z()));
}

/// Whether the block of `move` has M or G90: such a block is itself the first piece.
bool acts_from_its_beginning(const Program& program, const Move& move) {
  const std::string_view block =
      std::string_view(program.text).substr(move.block.begin, move.block.end - move.block.begin);
  return block.find('M') != std::string_view::npos || block.find("G90") != std::string_view::npos;
}

/// Edits that move every end by its correction, in `pieces` pieces if the block may be split and has no word
/// that acts at its beginning (or `also_acting`). Arcs have a centre that moves with them. If `chorded`
/// is not 0, every `chorded`-th arc has no centre and becomes chords.
std::vector<MoveEdit> arc_edits(const Program& program, int pieces, std::size_t chorded = 0,
                                bool also_acting = false, double variation = little) {
  std::vector<MoveEdit> edits;
  const auto correction = [&](const Vector3& p) { return arc_correction(p, variation); };
  for (std::size_t m = 0; m < program.moves.size(); ++m) {
    const Move& move = program.moves[m];
    MoveEdit edit{.move = m, .end_mm = move.end_mm + correction(move.end_mm)};
    const Curve way = way_of(move);
    const bool known = move.known_start == std::array{true, true, true};
    const auto centre = [&](double u) -> std::optional<Vector3> {
      const bool chords = chorded > 0 && m % chorded == 0 && (way.end - way.start).norm() > 0.1;
      if (!move.arc || chords) return std::nullopt;
      return move.arc->centre_mm + correction(point_at(way, u));
    };
    const bool whole = !also_acting && acts_from_its_beginning(program, move);
    const int parts = known && move.may_split && !whole ? pieces : 1;
    for (int i = 1; i < parts; ++i) {
      const Vector3 p = point_at(way, static_cast<double>(i) / parts);
      edit.inserted.push_back({p + correction(p), centre(static_cast<double>(i) / parts)});
    }
    edit.centre_mm = centre(1);
    edits.push_back(edit);
  }
  return edits;
}

/// The curves that `as_written` gives for the pieces of `edit`, without those that do not move. Sets
/// `position` to the last inserted point.
std::vector<Curve> predicted(const Move& move, const MoveEdit& edit, TextPosition& position) {
  std::vector<Curve> curves;
  for (const Via& via : edit.inserted) {
    const Curve curve = as_written(move, position, via, false, {});
    position = {curve.end.x(), curve.end.y(), curve.end.z()};
    if (curve.end != curve.start) curves.push_back(curve);
  }
  curves.push_back(as_written(move, position, {edit.end_mm, edit.centre_mm}, true, {}));
  return curves;
}

void check_same(const Curve& read, const Curve& expected) {
  CHECK((read.start - expected.start).norm() < 1e-9);
  CHECK((read.end - expected.end).norm() < 1e-9);
  REQUIRE(read.arc.has_value() == expected.arc.has_value());
  if (!read.arc) return;
  CHECK((read.arc->centre - expected.arc->centre).norm() < 1e-7);
  CHECK(std::abs(read.arc->sweep - expected.arc->sweep) < 1e-7);
  CHECK(read.arc->normal == expected.arc->normal);
}

/// A line without blanks, with masked numbers of its position words, and without position words that
/// `original` does not have.
std::string masked(const std::string& line, const std::string& original, bool timed) {
  std::string kept;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char upper = static_cast<char>(line[i] & ~0x20);
    if (line[i] == ' ') continue;
    const bool place = std::string_view("XYZIJKR").find(upper) != std::string_view::npos;
    const bool in_original =
        original.find_first_of({upper, static_cast<char>(upper | 0x20)}) != std::string::npos;
    if (in_original || !place) kept += line[i];
    if (!place && !(timed && upper == 'F')) continue;
    while (i + 1 < line.size() &&
           std::string_view("+-.0123456789").find(line[i + 1]) != std::string_view::npos)
      ++i;
  }
  return kept;
}

/// Every line except the inserted ones is the original's, apart from the position words.
void check_masked(const Program& program, const std::vector<MoveEdit>& edits) {
  const Rewritten out = rewrite(program, edits, {});
  const std::vector<std::string> before = lines_of(program.text), after = lines_of(out.text);
  REQUIRE(after.size() == before.size() + out.inserted_blocks);
  std::size_t edit = 0, next = 0;
  for (std::size_t i = 0; i < before.size(); ++i, ++next) {
    const bool is_move =
        edit < edits.size() && program.moves[edits[edit].move].line == static_cast<int>(i) + 1;
    if (is_move) next += out.blocks_of_edit[edit++];
    CHECK(masked(after[next], before[i], true) == masked(before[i], before[i], true));
  }
}

void check_read_back(const Program& program, const std::vector<MoveEdit>& edits) {
  const std::string text = rewrite(program, edits, {}).text;
  const Program again = read_small(text);
  const Program again_here = read(text);
  REQUIRE(again.moves.size() == again_here.moves.size());
  for (std::size_t m = 0; m < again.moves.size(); ++m)
    if (all_known(again.moves[m].known_start))
      check_same(way_of(again_here.moves[m]), way_of(again.moves[m]));
  TextPosition position{};
  std::size_t next = 0;
  for (std::size_t m = 0; m < program.moves.size(); ++m) {
    const Move& move = program.moves[m];
    CAPTURE(move.line);
    if (move.known_start == std::array{true, true, true}) {
      for (const Curve& expected : predicted(move, edits[m], position)) {
        REQUIRE(next < again.moves.size());
        check_same(way_of(again.moves[next++]), expected);
      }
    } else {
      ++next;
    }
    position = text_position_after(move, position, edits[m].end_mm, {});
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (position[axis])
        CHECK(std::abs(again.moves[next - 1].end_mm[static_cast<Eigen::Index>(axis)] - *position[axis]) <
              1e-9);
  }
  CHECK(next == again.moves.size());
}

}  // namespace

TEST_CASE("edits of arcs and relative moves to their own ends reproduce every byte") {
  SyntheticArcs source(21);
  for (int i = 0; i < arc_programs; ++i) {
    const std::string text = source.text(arc_blocks);
    CAPTURE(text);
    const Program program = read_small(text);
    std::vector<MoveEdit> edits;
    for (std::size_t m = 0; m < program.moves.size(); ++m) {
      edits.push_back({.move = m, .end_mm = program.moves[m].end_mm});
      if (program.moves[m].arc) edits.back().centre_mm = program.moves[m].arc->centre_mm;
    }
    CHECK(rewrite(program, edits, {}).text == text);
  }
}

TEST_CASE("a corrected arc is read back as as_written predicts: start, end, centre and sweep") {
  SyntheticArcs source(22);
  for (int i = 0; i < arc_programs; ++i) {
    const Program program = read_small(source.text(arc_blocks));
    CAPTURE(program.text);
    check_read_back(program, arc_edits(program, 1));
  }
}

TEST_CASE("the pieces of split lines and arcs are read back as as_written predicts") {
  SyntheticArcs source(23);
  for (int i = 0; i < arc_programs; ++i) {
    const Program program = read_small(source.text(arc_blocks));
    CAPTURE(program.text);
    check_read_back(program, arc_edits(program, 2 + i % 3));
  }
}

TEST_CASE("chords and arcs in alternation are read back as as_written predicts") {
  SyntheticArcs source(24);
  for (int i = 0; i < arc_programs; ++i) {
    const Program program = read_small(source.text(arc_blocks));
    CAPTURE(program.text);
    check_read_back(program, arc_edits(program, 1 + i % 3, 3));
  }
}

TEST_CASE("a block that is not edited moves as before, also behind chords") {
  const auto is_chorded = [](const Move& move, std::size_t m) {
    return move.arc && m % 4 == 0 && (move.end_mm - move.start_mm).norm() > 0.1;
  };
  SyntheticArcs source(25);
  for (int i = 0; i < arc_programs; ++i) {
    const Program program = read_small(source.text(arc_blocks));
    CAPTURE(program.text);
    std::vector<MoveEdit> edits;
    for (std::size_t m = 0; m < program.moves.size(); ++m)
      if (is_chorded(program.moves[m], m)) edits.push_back({.move = m, .end_mm = program.moves[m].end_mm});
    const Program again = read_small(rewrite(program, edits, {}).text);
    REQUIRE(again.moves.size() == program.moves.size());
    for (std::size_t m = 0; m < program.moves.size(); ++m) {
      CAPTURE(program.moves[m].line);
      CHECK((again.moves[m].end_mm - program.moves[m].end_mm).norm() < 1e-9);
      const bool arc = program.moves[m].arc && !is_chorded(program.moves[m], m);
      REQUIRE(again.moves[m].arc.has_value() == arc);
      if (arc) CHECK(again.moves[m].arc->clockwise == program.moves[m].arc->clockwise);
    }
  }
}

TEST_CASE("around arcs, all bytes except position words and insertions are the original's") {
  SyntheticArcs source(26);
  for (int i = 0; i < arc_programs; ++i) {
    const Program program = read_small(source.text(arc_blocks));
    CAPTURE(program.text);
    check_masked(program, arc_edits(program, 1 + i % 3));
  }
}

TEST_CASE("a block that is itself the first piece of its split ends at its target, too") {
  SyntheticArcs source(27);
  for (int i = 0; i < arc_programs; ++i) {
    const Program program = read_small(source.text(arc_blocks));
    CAPTURE(program.text);
    const std::vector<MoveEdit> edits = arc_edits(program, 3, 5, true);
    const Rewritten out = rewrite(program, edits, {});
    const Program again = read(out.text);
    REQUIRE(again.moves.size() == program.moves.size() + out.inserted_blocks);
    std::size_t next = 0;
    for (std::size_t m = 0; m < program.moves.size(); ++m) {
      next += out.blocks_of_edit[m] + 1;
      const Move& last = again.moves[next - 1];
      const Move& move = program.moves[m];
      CAPTURE(move.line);
      const double half = move.unit == LengthUnit::millimetres ? 0.5e-3 : 0.5e-4 * 25.4;
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (move.known_start[axis])
          CHECK(std::abs((last.end_mm - edits[m].end_mm)[static_cast<Eigen::Index>(axis)]) <= half + 1e-9);
    }
  }
}

TEST_CASE("no piece of an arc with few digits becomes an additional turn") {
  SyntheticArcs source(28, 0.002, 0.03);
  std::size_t arcs = 0, lines = 0;
  for (int i = 0; i < arc_programs; ++i) {
    const Program program = read_small(source.text(arc_blocks));
    CAPTURE(program.text);
    const std::vector<MoveEdit> edits = arc_edits(program, 1 + i % 4, 0, false, 1);
    const Rewritten out = rewrite(program, edits, {});
    const Program again = read_small(out.text);
    std::size_t next = 0;
    for (std::size_t m = 0; m < program.moves.size(); ++m) {
      const Curve way = way_of(program.moves[m]);
      double turned = 0;
      for (std::size_t k = 0; k <= out.blocks_of_edit[m]; ++k, ++next) {
        const Curve piece = way_of(again.moves[next]);
        if (piece.arc) turned += piece.arc->sweep;
        if (way.arc) ++(piece.arc ? arcs : lines);
      }
      CAPTURE(program.moves[m].line);
      if (way.arc) CHECK(turned < way.arc->sweep + std::numbers::pi);
    }
    CHECK(next == again.moves.size());
  }
  CHECK(arcs > 10000);
  CHECK(lines > 100);
}
