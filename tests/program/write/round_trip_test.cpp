#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "program/reading.hpp"
#include "program/synthetic_program.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr int programs = 400;
constexpr int blocks = 120;

/// A smooth correction like that of a machine, up to 0.2 mm.
Vector3 correction(const Vector3& p_mm) {
  return {0.2 * std::sin(p_mm.y() / 30), 0.1 * std::cos(p_mm.x() / 20),
          0.05 * std::sin(p_mm.x() / 7 + p_mm.z())};
}

std::vector<MoveEdit> corrected(const Program& program) {
  std::vector<MoveEdit> edits = edits_to_original(program);
  for (MoveEdit& edit : edits) edit.end_mm += correction(edit.end_mm);
  return edits;
}

/// The same with inserted points in all moves that may be split.
std::vector<MoveEdit> split(const Program& program) {
  std::vector<MoveEdit> edits = corrected(program);
  for (MoveEdit& edit : edits) {
    const Move& move = program.moves[edit.move];
    if (!move.may_split || move.known_start != std::array{true, true, true}) continue;
    for (const double s : {0.25, 0.5, 0.75}) {
      const Vector3 p = move.start_mm + s * (move.end_mm - move.start_mm);
      edit.inserted.push_back({p + correction(p)});
    }
  }
  return edits;
}

/// `text` without axis words, G words and blanks: rewriting must not change it.
std::string untouchable(const std::string& text) {
  std::string kept;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '(' || c == ';') {
      const std::size_t end = std::min(text.find(c == '(' ? ')' : '\n', i), text.size());
      kept += text.substr(i, end - i);
      i = end - 1;
    } else if (std::string_view("XYZxyz").find(c) != std::string_view::npos) {
      while (i + 1 < text.size() &&
             std::string_view("+-.0123456789").find(text[i + 1]) != std::string_view::npos)
        ++i;
    } else if (c != ' ') {
      kept += c;
    }
  }
  return kept;
}

/// The moves of `program` that are the last pieces of original moves.
std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST_CASE("rewriting without edits, or with edits that change nothing, reproduces every byte") {
  SyntheticProgram source(11);
  for (int i = 0; i < programs; ++i) {
    const std::string text = source.text(blocks);
    CAPTURE(i);
    const Program program = read(text);
    CHECK(rewrite(program, {}, {}).text == text);
    const Rewritten same = rewrite(program, edits_to_original(program), {});
    CHECK(same.text == text);
    CHECK(same.changed_words + same.inserted_words + same.inserted_blocks == 0);
    CHECK(rewrite(program, edits_to_original(program), {.decimals = 1}).text == text);
  }
}

TEST_CASE("the corrected text moves to its targets, to the last bit as text_position_after predicts") {
  SyntheticProgram source(12);
  for (int i = 0; i < programs; ++i) {
    const Program program = read(source.text(blocks));
    CAPTURE(i);
    const std::vector<MoveEdit> edits = corrected(program);
    const Program again = read(rewrite(program, edits, {}).text);
    REQUIRE(again.moves.size() == program.moves.size());
    TextPosition position{};
    for (std::size_t m = 0; m < program.moves.size(); ++m) {
      const Move& move = program.moves[m];
      const TextPosition before = position;
      position = text_position_after(move, before, edits[m].end_mm, {});
      CAPTURE(move.line);
      const double half = move.unit == LengthUnit::millimetres ? 0.5e-3 : 0.5e-4 * 25.4;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<Eigen::Index>(axis);
        if (position[axis]) CHECK(again.moves[m].end_mm[k] == *position[axis]);
        if (move.known_end[axis])
          CHECK(std::abs(again.moves[m].end_mm[k] - edits[m].end_mm[k]) <= half + 1e-9);
      }
    }
  }
}

TEST_CASE("pieces of split moves are additional moves, and all other moves stay") {
  SyntheticProgram source(13);
  std::size_t inserted = 0;
  for (int i = 0; i < programs; ++i) {
    const Program program = read(source.text(blocks));
    CAPTURE(i);
    const std::vector<MoveEdit> edits = split(program);
    const Rewritten out = rewrite(program, edits, {});
    const Program again = read(out.text);
    CHECK(again.moves.size() == program.moves.size() + out.inserted_blocks);
    CHECK(lines_in(out.text) == lines_in(program.text) + out.inserted_blocks);
    CHECK(again.left_alone.size() == program.left_alone.size());
    if (out.inserted_blocks == 0) CHECK(untouchable(out.text) == untouchable(program.text));
    inserted += out.inserted_blocks;
  }
  CHECK(inserted > 10000);
}

TEST_CASE("a correction without inserted points changes only axis words") {
  SyntheticProgram source(14);
  for (int i = 0; i < programs; ++i) {
    const Program program = read(source.text(blocks));
    CAPTURE(i);
    const Rewritten out = rewrite(program, corrected(program), {});
    CHECK(out.text != program.text);
    CHECK(untouchable(out.text) == untouchable(program.text));
    CHECK(out.text.find("-0.000 ") == std::string::npos);
  }
}

TEST_CASE("random bytes are read, or refused with a position") {
  SyntheticProgram source(15);
  std::mt19937_64 bits(16);
  int refused = 0;
  for (int i = 0; i < programs; ++i) {
    std::string text = source.text(30);
    for (int k = 0; k < 3; ++k) text[bits() % text.size()] = static_cast<char>(bits() % 256);
    CAPTURE(text);
    try {
      const Program program = read(text);
      CHECK(rewrite(program, edits_to_original(program), {}).text == text);
    } catch (const InputError& error) {
      ++refused;
      CHECK(error.where().line > 0);
      CHECK(error.where().column > 0);
    }
  }
  CHECK(refused > programs / 4);
}
