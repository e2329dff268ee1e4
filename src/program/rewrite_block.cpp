#include "program/rewrite_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "program/force_comment.hpp"
#include "program/held_position.hpp"
#include "program/line_length.hpp"
#include "program/number_style.hpp"

namespace counterflex {
namespace {

constexpr std::string_view axis_letters = "XYZ";

bool is_axis(const Word& word) {
  return axis_letters.find(word.letter) != std::string_view::npos;
}
bool is_motion(const Word& word) {
  return word.letter == 'G' && (word.value == 0 || word.value == 1);
}

/// Characters put in place of a span of the block.
struct Change {
  Span span;
  std::string text;
};

/// The block being rewritten, lexed again, and what the copies of it share.
struct Original {
  const Program& program;
  const Dialect& dialect;
  const Move& move;
  Block block{};
  std::string separator{};
  std::string line_end{};
  bool lower_case = false;
  bool acts_itself =
      false;  ///< other words than motion, axes, F and N: it is the first piece of its own split

  std::string_view text(Span span) const { return part(program.text, span); }
};

bool is_lower(char c) {
  return c >= 'a' && c <= 'z';
}

const Word& last_axis_word(const Block& block) {
  const auto last = std::find_if(block.words.rbegin(), block.words.rend(), is_axis);
  assert(last != block.words.rend());
  return *last;
}

/// What stands before the last axis word, where that is blanks or nothing behind another word.
std::string separator_of(const Original& o, const std::string& otherwise) {
  const Word* last = &last_axis_word(o.block);
  if (last == o.block.words.data()) return otherwise;
  const std::string_view gap = o.text({(last - 1)->span.end, last->span.begin});
  if (gap.find_first_not_of(" \t") != std::string_view::npos) return otherwise;
  return std::string(is_axis(*(last - 1)) ? gap : gap.substr(0, 1));
}

/// Whether the block holds other words than motion, axes, F and N, or sets the force: it acts from its
/// beginning.
bool acts_itself(const Original& o) {
  return std::any_of(o.block.words.begin(), o.block.words.end(),
                     [](const Word& word) {
                       return !is_axis(word) && !is_motion(word) && word.letter != 'F' && word.letter != 'N';
                     }) ||
         std::any_of(o.block.comments.begin(), o.block.comments.end(), [&](Span comment) {
           return read_force_comment(o.program.text, o.program.file, o.block, comment).has_value();
         });
}

Original lex_again(const Program& program, const Move& move, const ProgramStyle& style) {
  Original o{program, *find_dialect(program.dialect), move};
  o.block.line = move.line;
  o.block.span = move.block;
  lex(program.text, program.file, o.dialect, o.block);
  const std::size_t newline = program.text.find('\n', move.block.end);
  o.line_end = newline == std::string::npos
                   ? style.line_end
                   : program.text.substr(move.block.end, newline + 1 - move.block.end);
  o.separator = separator_of(o, style.separator);
  o.lower_case = is_lower(program.text[last_axis_word(o.block).span.begin]);
  o.acts_itself = acts_itself(o);
  return o;
}

char letter_of(const Original& o, char upper) {
  return o.lower_case ? static_cast<char>(upper - 'A' + 'a') : upper;
}

std::string axis_word(const Original& o, std::size_t axis, double value, int decimals) {
  return fmt::format("{}{}", letter_of(o, axis_letters[axis]), inserted_number(value, decimals));
}

/// The `motion` word of an inserted block: the original's, or "G1" where a feed move precedes a rapid.
std::string motion_text(const Original& o, bool jump) {
  if (jump && o.move.motion == Motion::rapid) return fmt::format("{}1", letter_of(o, 'G'));
  const auto motion = std::find_if(o.block.words.begin(), o.block.words.end(), is_motion);
  return motion == o.block.words.end() ? std::string() : std::string(o.text(motion->span));
}

std::string feed_text(const Original& o) {
  const auto feed =
      std::find_if(o.block.words.begin(), o.block.words.end(), [](auto& w) { return w.letter == 'F'; });
  return feed == o.block.words.end() || o.move.motion == Motion::rapid ? std::string()
                                                                       : std::string(o.text(feed->span));
}

/// '/' with the blanks that follow it.
std::string block_delete_text(const Original& o) {
  Span span = o.block.block_delete;
  if (empty(span)) return {};
  while (span.end < o.block.span.end && o.program.text[span.end] == ' ') ++span.end;
  return std::string(o.text(span));
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

/// A block that ends in ';' on controls where that ends a block.
bool ends_in_semicolon(const Original& o) {
  return !o.dialect.semicolon_comments && o.text(o.block.span).find(';') != std::string_view::npos;
}

/// The text of an inserted block that moves to `point_mm`; empty where the text already holds that point.
std::string piece(const Original& o, const Vector3& point_mm, const std::array<int, 3>& decimals, bool jump,
                  HeldPosition& held) {
  std::vector<std::string> words{motion_text(o, jump)};
  bool moves = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Coordinate c =
        settle_inserted(o.move, axis, held[axis], point_mm[static_cast<Eigen::Index>(axis)], decimals[axis]);
    if (c.write) words.push_back(axis_word(o, axis, c.value, decimals[axis]));
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

}  // namespace

ProgramStyle style_of(const Program& program) {
  ProgramStyle style{" ", "\n"};
  const std::size_t newline = program.text.find('\n');
  if (newline != std::string::npos && newline > 0 && program.text[newline - 1] == '\r')
    style.line_end = "\r\n";
  for (const Move& move : program.moves) {
    if (!move.words[0] || !move.words[1] || move.words[1]->number.begin < move.words[0]->number.end) continue;
    const std::size_t begin = move.words[0]->number.end;
    const std::string_view gap = part(program.text, {begin, move.words[1]->number.begin});
    const std::size_t letter = gap.find_first_of("Yy");
    if (letter != std::string_view::npos && gap.find_first_not_of(" \t") == letter) {
      style.separator = gap.substr(0, letter);
      break;
    }
  }
  return style;
}

void rewrite_block(const Program& program, const ProgramStyle& style, const MoveEdit& edit,
                   const WriteOptions& options, HeldPosition& held, Rewritten& out) {
  const Move& move = program.moves[edit.move];
  assert(edit.inserted_mm.empty() || move.may_split);
  assert(!edit.jump_mm || move.may_jump);
  const Original o = lex_again(program, move, style);
  const Decimals decimals = decimals_of(move, options);
  const std::array<int, 3> inside{decimals.inserted, decimals.inserted, decimals.inserted};
  const HeldPosition before = held = held_at_start(move, held);

  std::vector<Vector3> points = edit.inserted_mm;
  const bool feed = move.motion == Motion::feed;
  if (edit.jump_mm && feed) points.insert(points.begin(), *edit.jump_mm);
  points.push_back(edit.end_mm);
  const std::size_t own =
      o.acts_itself ? 0 : points.size() - 1;  // which of the points the block itself moves to

  std::string text;
  const auto add_piece = [&](const Vector3& point, const std::array<int, 3>& digits, bool jump,
                             bool in_front) {
    const std::string line = piece(o, point, digits, jump, held);
    if (line.empty()) return false;
    text += in_front ? line + o.line_end : o.line_end + line;
    ++out.inserted_blocks;
    return true;
  };
  const bool jumped = edit.jump_mm && !feed && add_piece(*edit.jump_mm, inside, true, true);
  for (std::size_t i = 0; i < own; ++i) add_piece(points[i], inside, false, true);
  std::vector<Change> changes =
      end_changes(o, points[own], own + 1 == points.size() ? decimals.end : inside, held, out);
  if (jumped) restore_motion(o, changes, out);
  const std::string line = applied(o, changes);
  text += line;
  for (std::size_t i = own + 1; i < points.size(); ++i)
    add_piece(points[i], i + 1 == points.size() ? decimals.end : inside, false, false);

  if (text != o.text(o.block.span)) check_integer_words(o);
  check_length(o, line);
  doubt_skippable(move, before, held);
  out.text += text;
}

}  // namespace counterflex
