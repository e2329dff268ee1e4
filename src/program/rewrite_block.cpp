#include "program/rewrite_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "program/held_position.hpp"
#include "program/line_length.hpp"
#include "program/number_style.hpp"

namespace counterflex {
namespace {

constexpr std::string_view axis_letters = "XYZ";

/// Characters put in place of a span of the block.
struct Change {
  Span span;
  std::string text;
};

std::string axis_word(const Original& o, std::size_t axis, double value, int decimals) {
  return fmt::format("{}{}", letter_of(o, axis_letters[axis]), inserted_number(value, decimals));
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) {
    if (word.empty()) continue;
    if (!text.empty()) text += separator;
    text += word;
  }
  return text;
}

/// A point that the text comes to, in an inserted block or in the block itself.
struct Stop {
  Vector3 point_mm;
  std::array<int, 3> decimals;
  bool jump = false;
};

/// The text of an inserted block that moves to `stop`; empty where the text already holds that point.
std::string piece(const Original& o, const Stop& stop, HeldPosition& held) {
  const bool feed_before_rapid = stop.jump && o.move.motion == Motion::rapid;
  std::vector<std::string> words{feed_before_rapid ? fmt::format("{}1", letter_of(o, 'G')) : motion_text(o)};
  bool moves = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double wanted_mm = stop.point_mm[static_cast<Eigen::Index>(axis)];
    const Coordinate c = settle_inserted(o.move, axis, held[axis], wanted_mm, stop.decimals[axis]);
    if (c.write) words.push_back(axis_word(o, axis, c.value, stop.decimals[axis]));
    moves = moves || c.write;
    held[axis] = c.held_mm;
  }
  if (!moves) return {};
  words.push_back(feed_text(o));
  return block_delete_text(o) + joined(words, o.separator) + (ends_in_semicolon(o) ? ";" : "");
}

/// The changes that bring the block's own end to `end_mm`.
std::vector<Change> end_changes(const Original& o, const Vector3& end_mm, const std::array<int, 3>& decimals,
                                HeldPosition& held, Rewritten& out) {
  std::vector<Change> changes;
  std::string inserted;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Coordinate c =
        settle_end(o.move, axis, held[axis], end_mm[static_cast<Eigen::Index>(axis)], decimals[axis]);
    held[axis] = c.held_mm;
    if (!c.write) continue;
    if (const auto& word = o.move.words[axis]) {
      changes.push_back({word->number, changed_number(o.text(word->number), c.value, decimals[axis])});
      ++out.changed_words;
    } else {
      inserted += o.separator + axis_word(o, axis, c.value, decimals[axis]);
      ++out.inserted_words;
    }
  }
  const std::size_t at = last_axis_word(o.block).span.end;
  if (!inserted.empty()) changes.push_back({{at, at}, inserted});
  return changes;
}

/// After a feed move put before a rapid the block must say G0 itself.
void restore_motion(const Original& o, std::vector<Change>& changes, Rewritten& out) {
  if (std::any_of(o.block.words.begin(), o.block.words.end(), is_motion)) return;
  const std::size_t at = std::find_if(o.block.words.begin(), o.block.words.end(), is_axis)->span.begin;
  changes.push_back({{at, at}, fmt::format("{}0{}", letter_of(o, 'G'), o.separator)});
  ++out.inserted_words;
}

void check_integer_words(const Original& o) {
  if (!o.dialect.integer_words_doubtful || o.program.integer_words != IntegerWords::unsaid) return;
  for (const Word& word : o.block.words)
    if (is_axis(word) && !word.point && word.value != 0)
      refuse(o.program.file, o.block, word.span.begin,
             fmt::format(
                 "{}{} has no point, and the block must be rewritten: it may mean units or increments; say "
                 "which with --integer-words units|increments",
                 word.letter, word.value));
}

void check_length(const Original& o, std::string_view line) {
  const std::size_t limit = o.dialect.line_limit;
  if (limit == 0 || line.size() <= limit) return;
  const std::size_t length = counted_length(o.dialect, line);
  if (length <= limit || length <= counted_length(o.dialect, o.text(o.block.span))) return;
  refuse(
      o.program.file, o.block, o.block.span.begin + limit,
      fmt::format("the corrected line would have {} characters; {} reads {}", length, o.dialect.name, limit));
}

std::string applied(const Original& o, std::vector<Change> changes) {
  std::stable_sort(changes.begin(), changes.end(),
                   [](const Change& a, const Change& b) { return a.span.begin < b.span.begin; });
  std::string line;
  std::size_t at = o.block.span.begin;
  for (const Change& change : changes) {
    line += o.text({at, change.span.begin});
    line += change.text;
    at = change.span.end;
  }
  line += o.text({at, o.block.span.end});
  return line;
}

/// Whether a skippable block or a piece of it has moved the axis, the text does not tell.
void doubt_skippable(const Move& move, const HeldPosition& before, HeldPosition& held) {
  if (!move.block_delete) return;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (move.words[axis] || before[axis] != held[axis]) held[axis].reset();
}

/// The points of an edit in order, and which of them the block itself moves to.
struct Plan {
  std::vector<Stop> stops;
  std::size_t own = 0;
};

Plan plan(const Original& o, const MoveEdit& edit, const WriteOptions& options) {
  const Decimals decimals = decimals_of(o.move, options);
  const std::array<int, 3> inside{decimals.inserted, decimals.inserted, decimals.inserted};
  Plan plan;
  if (edit.jump_mm) plan.stops.push_back({*edit.jump_mm, inside, true});
  for (const Via& via : edit.inserted) plan.stops.push_back({via.end_mm, inside});
  plan.stops.push_back({edit.end_mm, decimals.end});
  const bool first = o.acts_itself && o.move.motion == Motion::feed;
  plan.own = first ? 0 : plan.stops.size() - 1;
  return plan;
}

/// The block itself, moving to its own stop.
std::string own_text(const Original& o, const Stop& stop, bool after_jump, HeldPosition& held,
                     Rewritten& out) {
  std::vector<Change> changes = end_changes(o, stop.point_mm, stop.decimals, held, out);
  if (after_jump && o.move.motion == Motion::rapid) restore_motion(o, changes, out);
  std::string line = applied(o, std::move(changes));
  check_length(o, line);
  return line;
}

}  // namespace

void rewrite_block(const Program& program, const ProgramStyle& style, const MoveEdit& edit,
                   const WriteOptions& options, HeldPosition& held, Rewritten& out) {
  const Move& move = program.moves[edit.move];
  assert(edit.inserted.empty() || move.may_split);
  assert(!edit.jump_mm || move.may_jump);
  const Original o = lex_again(program, move, style);
  const Plan todo = plan(o, edit, options);
  const HeldPosition before = held = held_at_start(move, held);
  const std::size_t inserted_before = out.inserted_blocks;

  std::string text;
  for (std::size_t i = 0; i < todo.stops.size(); ++i) {
    const Stop& stop = todo.stops[i];
    if (i == todo.own) {
      text += own_text(o, stop, out.inserted_blocks > inserted_before, held, out);
      continue;
    }
    const std::string line = piece(o, stop, held);
    if (line.empty()) continue;
    text += i < todo.own ? line + o.line_end : o.line_end + line;
    ++out.inserted_blocks;
  }
  if (text != o.text(o.block.span)) check_integer_words(o);
  doubt_skippable(move, before, held);
  out.text += text;
}

}  // namespace counterflex
