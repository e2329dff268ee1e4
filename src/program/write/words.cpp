#include "program/write/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "program/text/line_length.hpp"
#include "program/text/number_style.hpp"

namespace counterflex {
namespace {

constexpr std::string_view axis_letters = "XYZ", centre_letters = "IJK", angle_letters = "ABC";

/// Characters that replace a span of the block.
struct Change {
  Span span;
  std::string text;
};

/// The changes of a block, and their number of words.
struct Changes {
  std::vector<Change> list;
  std::size_t changed = 0, inserted = 0;
};

std::string word_text(const Original& o, char letter, const WordNumber& number) {
  return fmt::format("{}{}", letter_of(o, letter), inserted_number(number.value, number.decimals));
}

/// In an inserted block: an axis that is relative in the original's block, beside absolute ones, gets its
/// mode.
std::string point_text(const Original& o, std::size_t axis, const WordNumber& number) {
  if (o.move.relative || !is_relative(o.move, axis)) return word_text(o, axis_letters[axis], number);
  return fmt::format("{}=IC({})", letter_of(o, axis_letters[axis]),
                     inserted_number(number.value, number.decimals));
}

std::string radius_text(const Original& o, const WordNumber& number) {
  if (o.dialect.radius_name.size() == 1) return word_text(o, 'R', number);
  return fmt::format("{}{}", o.dialect.radius_name, inserted_number(number.value, number.decimals));
}

/// A Sinumerik has no G90.1: absolute centres are marked word by word.
std::string centre_text(const Original& o, std::size_t axis, const WordNumber& number) {
  if (!o.dialect.sinumerik_words || !o.move.arc->absolute_centre)
    return word_text(o, centre_letters[axis], number);
  return fmt::format("{}=AC({})", letter_of(o, centre_letters[axis]),
                     inserted_number(number.value, number.decimals));
}

void change_word(const Original& o, const AxisWord& word, const WordNumber& number, Changes& changes) {
  changes.list.push_back({word.number, changed_number(o.text(word.number), number.value, number.decimals)});
  ++changes.changed;
}

/// Position behind the last word for which `belongs`, else behind the word before the first one for which
/// `follows`. That word may itself be removed with its blanks.
void insert_words(const Original& o, const std::vector<std::string>& texts, bool (*belongs)(const Word&),
                  bool (*follows)(const Word&), Changes& changes) {
  if (texts.empty()) return;
  const auto& words = o.block.words;
  const auto last = std::find_if(words.rbegin(), words.rend(), belongs);
  const auto next = std::find_if(words.begin(), words.end(), follows);
  const bool before = last == words.rend() && next == words.begin();
  const std::size_t at = before                 ? next->span.begin
                         : last != words.rend() ? last->span.end
                         : next != words.end()  ? std::prev(next)->span.end
                                                : words.back().span.end;
  std::string text;
  for (const std::string& word : texts) text += before ? word + o.separator : o.separator + word;
  changes.list.push_back({{at, at}, text});
  changes.inserted += texts.size();
}

/// With the blanks before it, unless it is the first.
void drop_word(const Original& o, const Word& word, Changes& changes) {
  Span span = word.span;
  if (&word == o.block.words.data()) return changes.list.push_back({span, {}});
  const auto blank = [&](std::size_t at) { return o.program.text[at] == ' ' || o.program.text[at] == '\t'; };
  while (span.begin > o.block.span.begin && blank(span.begin - 1)) --span.begin;
  changes.list.push_back({span, {}});
}

/// A height of a called cycle, shifted by the rounded shift of its first one.
WordNumber shifted_height(const Move& move, std::size_t height, double shift_mm) {
  const AxisWord word = *move.called->heights[height];
  const int decimals =
      std::max(word.decimals, std::max((*move.called->heights[0]).decimals, resolution_decimals(move.unit)));
  return {true, rounded((move.called->heights_mm[height] + shift_mm) / mm_per(move.unit), decimals),
          decimals};
}

bool is_angle_or_centre(const Word& word) {
  return is_angle(word) || is_centre(word);
}

/// A, B and C.
void angle_changes(const Original& o, const Step& step, Changes& changes) {
  std::vector<std::string> inserted;
  for (std::size_t i = 0; i < angle_letters.size(); ++i) {
    if (!step.angles[i].write) continue;
    if (const auto& word = o.move.orientation->words[i])
      change_word(o, *word, step.angles[i], changes);
    else
      inserted.push_back(word_text(o, angle_letters[i], step.angles[i]));
  }
  insert_words(
      o, inserted, [](const Word& word) { return is_axis(word) || is_angle(word); }, is_centre, changes);
}

void axis_changes(const Original& o, const Step& step, const BesidesPoint& besides, Changes& changes) {
  std::vector<std::string> inserted;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const WordNumber& number = step.axes[axis].number;
    if (!number.write || (o.move.called && axis == 2)) continue;
    if (axis + 1 == o.move.angle_axis)  // the coordinate replaces the direction
      changes.list.push_back({o.block.angle->span, word_text(o, axis_letters[axis], number)}),
          ++changes.changed;
    else if (const auto& word = o.move.words[axis])
      change_word(o, *word, number, changes);
    else
      inserted.push_back(word_text(o, axis_letters[axis], number));
  }
  if (o.move.called && o.move.called->modal.empty() && besides.call_shift_mm != 0)
    for (std::size_t i = 0; i < o.move.called->heights.size(); ++i)
      if (const auto& word = o.move.called->heights[i])
        change_word(o, *word, shifted_height(o.move, i, besides.call_shift_mm), changes);
  if (o.move.cycle) {
    const CycleMove& cycle = *o.move.cycle;
    if (besides.cycle.retract.write) change_word(o, *cycle.retract_word, besides.cycle.retract, changes);
    if (besides.cycle.bottom.write && cycle.bottom_word)
      change_word(o, *cycle.bottom_word, besides.cycle.bottom, changes);
    else if (besides.cycle.bottom.write)
      inserted.push_back(word_text(o, 'Z', besides.cycle.bottom));
  }
  insert_words(o, inserted, is_axis, o.move.orientation ? is_angle_or_centre : is_centre, changes);
}

void centre_changes(const Original& o, const ArcWords& arc, Changes& changes) {
  std::vector<std::string> inserted;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const WordNumber& number = arc.centre[axis];
    if (!number.write) continue;
    if (const auto& word = o.move.arc->centre_words[axis])
      change_word(o, *word, number, changes);
    else
      inserted.push_back(centre_text(o, axis, number));
  }
  insert_words(o, inserted, is_centre, is_centre, changes);
  if (arc.radius.write) change_word(o, *o.move.arc->radius_word, arc.radius, changes);
}

/// The word of an arc that gives its turns; nullptr without such a word.
const Word* turns_word(const Original& o) {
  const bool path_mode = std::any_of(o.block.words.begin(), o.block.words.end(), [](const Word& word) {
    return word.letter == 'G' && (word.value == 64 || word.value == 4);
  });
  return path_mode || !arcs_have_turns(o.dialect) ? nullptr : find_word(o.block, 'P');
}

/// A chord has no centre, radius or turns. The last piece of an arc makes the turns.
void drop_arc_words(const Original& o, const Step& step, Changes& changes) {
  const bool chord = step.motion == 1;
  const Word* turns = turns_word(o);
  for (const Word& word : o.block.words)
    if ((chord && is_centre(word)) || (&word == turns && (chord || step.place != Place::end)))
      drop_word(o, word, changes);
}

void motion_changes(const Original& o, int motion, bool state_motion, Changes& changes) {
  const auto& words = o.block.words;
  const auto word = std::find_if(words.begin(), words.end(), is_motion);
  if (word != words.end()) {
    // An arc that is not followed has no arc for `motion_of`. It is not changed.
    if (motion != motion_of(o.move)) changes.list.push_back({word->span, motion_text(o, motion)});
    return;
  }
  const bool has_motion =
      std::any_of(words.begin(), words.end(), [&](auto& w) { return is_motion_word(w, o.dialect); });
  if (!state_motion || has_motion) return;
  const auto first = std::find_if(words.begin(), words.end(), [&](auto& w) {
    return is_axis(w) || is_centre(w) || (o.move.orientation && is_angle(w));
  });
  if (first == words.end()) return;
  ++changes.inserted;
  if (first != words.begin() && motion == 1 && is_centre(*first)) {  // a word that is removed with its blanks
    const std::size_t at = std::prev(first)->span.end;
    return changes.list.push_back({{at, at}, o.separator + motion_text(o, motion)});
  }
  changes.list.push_back({{first->span.begin, first->span.begin}, motion_text(o, motion) + o.separator});
}

/// A first word keeps the blanks behind it.
void block_number_changes(const Original& o, const std::string& number, Changes& changes) {
  const Word* word = find_word(o.block, 'N');
  if (word == nullptr) return;
  if (!number.empty()) return changes.list.push_back({word->span, number});
  drop_word(o, *word, changes);
}

/// The blanks that are left where an N was removed that was the first word of the block.
void drop_blanks_of_number(const Original& o, std::string& line) {
  const Word* word = find_word(o.block, 'N');
  if (word == nullptr || word != o.block.words.data()) return;
  const std::size_t begin = word->span.begin - o.block.span.begin,
                    end = std::min(line.find_first_not_of(" \t", begin), line.size());
  line.erase(begin, end - begin);
}

std::string feed_word(const Original& o, const PieceFeed& feed) {
  return fmt::format("{}{}", letter_of(o, 'F'), inserted_number(feed.value, feed.decimals));
}

void feed_changes(const Original& o, const PieceFeed& feed, Changes& changes) {
  const Word* word = find_word(o.block, 'F');
  if (word == nullptr)
    return insert_words(
        o, {feed_word(o, feed)}, [](const Word& w) { return is_axis(w) || is_angle(w); }, is_centre, changes);
  if (word->literal && word->value != feed.value)
    changes.list.push_back({word->number, changed_number(o.text(word->number), feed.value, feed.decimals)});
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
  std::stable_sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) {
    return a.span.begin != b.span.begin ? a.span.begin < b.span.begin : a.span.end < b.span.end;
  });
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

void append(const Original& o, const std::string& word, std::string& line) {
  if (word.empty()) return;
  if (!line.empty()) line += o.separator;
  line += word;
}

/// A centre word of an inserted block. A zero is written if the block itself has the word.
bool is_written(const ArcMove& arc, std::size_t axis, const WordNumber& number) {
  return in_plane(arc, axis) && (arc.absolute_centre || arc.centre_words[axis] || number.value != 0);
}

void append_centre(const Original& o, const ArcWords& words, std::string& line) {
  const ArcMove& arc = *o.move.arc;
  if (arc.radius_word) return append(o, radius_text(o, words.radius), line);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (is_written(arc, axis, words.centre[axis])) append(o, centre_text(o, axis, words.centre[axis]), line);
}

}  // namespace

std::string own_block(const Original& o, const Step& step, const BesidesPoint& besides, Rewritten& out) {
  Changes changes;
  if (besides.number) block_number_changes(o, *besides.number, changes);
  motion_changes(o, step.motion, besides.state_motion, changes);
  axis_changes(o, step, besides, changes);
  if (o.move.orientation) angle_changes(o, step, changes);
  if (step.arc) centre_changes(o, *step.arc, changes);
  if (o.move.arc) drop_arc_words(o, step, changes);
  if (besides.feed) feed_changes(o, *besides.feed, changes);
  out.changed_words += changes.changed;
  out.inserted_words += changes.inserted;
  std::string line = applied(o, std::move(changes.list));
  if (besides.number && besides.number->empty()) drop_blanks_of_number(o, line);
  check_length(o, line);
  return line;
}

std::string restated_call(const Move& move, double shift_mm) {
  const CalledCycle& cycle = *move.called;
  if (shift_mm == 0) return cycle.modal;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < cycle.heights.size(); ++i)
    if (cycle.heights[i]) order.push_back(i);
  const auto begin_of = [&](std::size_t i) { return cycle.heights[i]->number.begin; };
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return begin_of(a) < begin_of(b); });
  std::string line;
  std::size_t at = 0;
  for (const std::size_t i : order) {
    const Span number = cycle.heights[i]->number;
    const WordNumber shifted = shifted_height(move, i, shift_mm);
    line.append(cycle.modal, at, number.begin - at)
        .append(changed_number(part(cycle.modal, number), shifted.value, shifted.decimals));
    at = number.end;
  }
  return line.append(cycle.modal, at);
}

std::string inserted_block(const Original& o, const Step& step, const BesidesPoint& besides) {
  std::string line = besides.number.value_or("");
  if (besides.state_motion || std::any_of(o.block.words.begin(), o.block.words.end(), is_motion))
    append(o, motion_text(o, step.motion), line);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (step.after[axis] && step.after[axis] != step.before[axis])
      append(o, point_text(o, axis, step.axes[axis].number), line);
  for (std::size_t i = 0; i < angle_letters.size(); ++i)
    if (o.move.orientation &&
        !(step.before.orientation && (*step.before.orientation)[i] == step.angles[i].value))
      append(o, word_text(o, angle_letters[i], step.angles[i]), line);
  if (step.arc) append_centre(o, *step.arc, line);
  if (const Word* turns = turns_word(o); step.arc && step.place == Place::end && turns != nullptr)
    append(o, std::string(o.text(turns->span)), line);
  append(o, besides.feed ? feed_word(o, *besides.feed) : feed_text(o), line);
  line = block_delete_text(o) + line + (ends_in_semicolon(o) ? ";" : "");
  check_length(o, line);
  return line;
}

}  // namespace counterflex
