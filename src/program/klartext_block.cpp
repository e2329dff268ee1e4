#include "program/klartext_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "counterflex/files/numbers.hpp"
#include "program/dialect.hpp"
#include "program/force_comment.hpp"
#include "program/number_style.hpp"
#include "program/rewrite_step.hpp"

namespace counterflex {
namespace {

constexpr std::string_view axis_names = "XYZ";

/// A block being rewritten, read again, and where its changes go.
struct KlartextWriter {
  const Program& program;
  const KlartextStyle& style;
  const Move& move;
  const WriteOptions& options;
  KlartextHeld& held;
  std::vector<KlartextChange>& changes;
  Rewritten& out;
  KlartextBlock block{};
  std::vector<KlartextWord> words{};
  std::vector<KlartextChange> own{};            ///< changes inside the block
  std::vector<std::string> before{}, behind{};  ///< statements of inserted lines

  double unit() const { return mm_per(move.unit); }
};

void sort_changes(std::vector<KlartextChange>& changes) {
  std::stable_sort(changes.begin(), changes.end(), [](const KlartextChange& a, const KlartextChange& b) {
    return a.span.begin < b.span.begin;
  });
}

bool is_axis_word(const KlartextWord& word) {
  return word.key.size() == 1 && axis_names.find(word.key[0]) != std::string_view::npos;
}

/// Whether the block does something at its beginning that its pieces must not forestall.
bool acts_itself(const KlartextWriter& w) {
  Block place;
  place.line = w.block.line;
  place.span = w.block.span;
  const bool sets_force = std::any_of(w.block.comments.begin(), w.block.comments.end(), [&](Span comment) {
    return read_force_comment(w.program.text, w.program.file, place, comment).has_value();
  });
  return sets_force || find_word(w.words, "M") != nullptr || find_word(w.words, "MB") != nullptr;
}

std::string klartext_word(const KlartextWriter& w, std::size_t axis, const WordNumber& number) {
  if (std::abs(number.value) > 99999.9999)
    refuse_klartext(w.program.text, w.program.file, w.block, w.block.span.begin,
                    fmt::format("the corrected {} would be {}; coordinates are at most 99999.9999",
                                axis_names[axis], format_fixed(number.value, number.decimals)));
  return fmt::format(" {}{}{}", w.move.relative ? "I" : "", axis_names[axis],
                     klartext_number(w.style, number.value, number.decimals));
}

/// The number of a word of the block, changed.
std::string changed_klartext(const KlartextWriter& w, const AxisWord& word, const WordNumber& number) {
  std::string original(part(w.program.text, word.number));
  const bool comma =
      original.find(',') != std::string::npos || (original.find('.') == std::string::npos && w.style.comma);
  std::erase(original, ' ');
  std::replace(original.begin(), original.end(), ',', '.');
  std::string text = changed_number(original, number.value, number.decimals);
  if (comma) std::replace(text.begin(), text.end(), '.', ',');
  return text;
}

/// A line of its own before or behind the block.
std::string inserted_line(const KlartextWriter& w, const std::string& statement) {
  std::string start;
  if (!empty(w.block.block_delete)) start += "/";
  if (w.style.numbered) start += "0 ";
  return start + statement;
}

std::string feed_of(const KlartextWriter& w) {
  if (w.move.motion == Motion::rapid) return {};
  for (const KlartextWord& word : w.words)
    if (word.key.starts_with('F')) return " " + std::string(part(w.program.text, word.span));
  return {};
}

std::string sense_of(const Move& move) {
  return move.arc->clockwise ? " DR-" : " DR+";
}

/// CC for the centre of `arc`, where the text does not hold it already.
void set_pole(KlartextWriter& w, const ArcWords& arc, std::vector<std::string>& statements) {
  bool there = w.held.pole_mm.has_value();
  std::string text = "CC";
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const WordNumber& number = arc.centre[axis];
    there = there && rounds_to(component(*w.held.pole_mm, axis) / w.unit(), number.value, number.decimals);
    text += fmt::format(" {}{}", axis_names[axis], klartext_number(w.style, number.value, number.decimals));
  }
  if (there) return;
  statements.push_back(text);
  w.held.pole_mm = arc.curve.arc->centre;
}

/// The words of the CC before the block, changed in place.
void change_pole(KlartextWriter& w, const ArcWords& arc) {
  std::vector<KlartextChange> changes;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const AxisWord& word = *w.move.arc->centre_words[axis];
    if (!arc.centre[axis].write) continue;
    changes.push_back({word.number, changed_klartext(w, word, arc.centre[axis])});
    ++w.out.changed_words;
  }
  sort_changes(changes);
  w.changes.insert(w.changes.end(), changes.begin(), changes.end());
  w.held.pole_mm = arc.curve.arc->centre;
}

/// The statements of an inserted piece.
void insert_step(KlartextWriter& w, const Step& step, bool states_feed,
                 std::vector<std::string>& statements) {
  std::string coordinates;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (step.after[axis] && step.after[axis] != step.before[axis])
      coordinates += klartext_word(w, axis, step.axes[axis].number);
  std::string head = "L", tail;
  if (step.arc && w.move.arc->radius_word) {
    head = "CR";
    tail =
        " R" + klartext_number(w.style, step.arc->radius.value, step.arc->radius.decimals) + sense_of(w.move);
  } else if (step.arc) {
    set_pole(w, *step.arc, statements);
    head = "C";
    tail = sense_of(w.move);
  }
  statements.push_back(head + coordinates + tail + (states_feed ? feed_of(w) : ""));
}

void change_coordinates(KlartextWriter& w, const Step& step) {
  std::string inserted;
  std::size_t behind = w.block.parts[0].begin + w.block.head.size();
  for (const KlartextWord& word : w.words)
    if (is_axis_word(word)) behind = word.span.end;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const WordNumber& number = step.axes[axis].number;
    if (!number.write) continue;
    const std::string text = klartext_word(w, axis, number);
    if (const auto& word = w.move.words[axis]) {
      w.own.push_back({word->number, changed_klartext(w, *word, number)});
      ++w.out.changed_words;
    } else {
      inserted += text;
      ++w.out.inserted_words;
    }
  }
  if (!inserted.empty()) w.own.push_back({{behind, behind}, inserted});
}

/// An arc that goes on as chords: its last piece is a line.
void make_line(KlartextWriter& w) {
  const std::size_t head = w.block.parts[0].begin;
  w.own.push_back({{head, head + w.block.head.size()}, "L"});
  for (const KlartextWord& word : w.words) {
    if (word.key != "DR" && word.key != "R") continue;
    std::size_t begin = word.span.begin;
    while (begin > head && w.program.text[begin - 1] == ' ') --begin;
    w.own.push_back({{begin, word.span.end}, ""});
  }
}

/// The block's own coordinates, and centre or radius of an arc.
void change_block(KlartextWriter& w, const Step& step, bool pole_is_own) {
  change_coordinates(w, step);
  if (!w.move.arc) return;
  if (step.motion == 1) return make_line(w);
  if (!step.arc) return;
  if (!w.move.arc->radius_word)
    return pole_is_own ? change_pole(w, *step.arc) : set_pole(w, *step.arc, w.before);
  if (!step.arc->radius.write) return;
  const AxisWord& word = *w.move.arc->radius_word;
  w.own.push_back({word.number, changed_klartext(w, word, step.arc->radius)});
  ++w.out.changed_words;
}

/// Puts what belongs before, into and behind the block into the list of changes.
void emit(KlartextWriter& w) {
  std::string text;
  for (const std::string& statement : w.before) text += inserted_line(w, statement) + w.style.line_end;
  if (!text.empty()) w.changes.push_back({{w.block.span.begin, w.block.span.begin}, text});
  sort_changes(w.own);
  w.changes.insert(w.changes.end(), w.own.begin(), w.own.end());
  text.clear();
  for (const std::string& statement : w.behind) text += w.style.line_end + inserted_line(w, statement);
  if (!text.empty()) w.changes.push_back({{w.block.span.end, w.block.span.end}, text});
  w.out.inserted_blocks += w.before.size() + w.behind.size();
}

/// A point of an edit, and how it is come to.
struct KlartextStop {
  Via via;
  int motion;
};

std::vector<KlartextStop> stops_of(const Move& move, const MoveEdit& edit) {
  std::vector<KlartextStop> stops;
  if (edit.jump_mm) stops.push_back({{*edit.jump_mm, {}}, 1});
  for (const Via& via : edit.inserted) stops.push_back({via, motion_of(move)});
  stops.push_back({{edit.end_mm, edit.centre_mm}, motion_of(move)});
  return stops;
}

void write_edit(KlartextWriter& w, const MoveEdit& edit) {
  const std::vector<KlartextStop> stops = stops_of(w.move, edit);
  const bool own_first = stops.size() > 1 && w.move.motion == Motion::feed && acts_itself(w);
  const std::size_t own = own_first ? 0 : stops.size() - 1;
  const bool has_pole = w.move.arc && w.move.arc->centre_words[0];
  if (has_pole) w.held.pole_mm = w.move.arc->centre_mm;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const bool end = i + 1 == stops.size();
    const Place place = end ? Place::end : i == own ? Place::own_inside : Place::inside;
    const Step step = settle_step(w.move, w.held.position, stops[i].via, stops[i].motion, place, w.options);
    if (i == own)
      change_block(w, step, has_pole && w.before.empty());
    else if (!is_there(step))
      insert_step(w, step, i < own, i < own ? w.before : w.behind);
    w.held.position = step.after;
  }
  emit(w);
}

bool has_words(const Move& move) {
  return move.words[0] || move.words[1] || move.words[2];
}

}  // namespace

std::string klartext_number(const KlartextStyle& style, double value, int decimals) {
  std::string text = inserted_number(value, decimals);
  if (style.comma) std::replace(text.begin(), text.end(), '.', ',');
  if (style.plus && text.front() != '-') text.insert(text.begin(), '+');
  return text;
}

KlartextStyle klartext_style(const Program& program) {
  KlartextStyle style;
  const std::size_t newline = program.text.find('\n');
  if (newline != std::string::npos && newline > 0 && program.text[newline - 1] == '\r')
    style.line_end = "\r\n";
  bool decided = false;
  for (const Move& move : program.moves) {
    style.numbered = style.numbered || move.block_number;
    for (const auto& word : move.words) {
      if (!word || decided) continue;
      const std::string_view number = part(program.text, word->number);
      style.plus = style.plus || number.starts_with('+');
      style.comma = number.find(',') != std::string_view::npos;
      decided = number.find_first_of(".,") != std::string_view::npos;
    }
  }
  return style;
}

void rewrite_klartext_block(const Program& program, const KlartextStyle& style, const MoveEdit& edit,
                            const WriteOptions& options, KlartextHeld& held,
                            std::vector<KlartextChange>& changes, Rewritten& out) {
  const Move& move = program.moves[edit.move];
  assert(edit.inserted.empty() || move.may_split);
  if (!has_words(move)) {
    held.position = held_after_original(move, held.position);
    return;
  }
  KlartextWriter w{program, style, move, options, held, changes, out};
  w.block.line_end = {move.block.begin, move.block.begin};
  w.block.last_line = move.line - 1;
  next_klartext_block(program.text, w.block);
  // CYCL CALL and M99 alone have no coordinates: the word of theirs stands in the cycle's definition.
  const bool calls_cycle = w.block.head == "CYCL" || w.block.head.starts_with('M');
  if (!calls_cycle) lex_klartext_words(program.text, program.file, w.block, w.words);
  held.position = held_at_start(move, held.position);
  const HeldPosition before = held.position;
  write_edit(w, edit);
  doubt_skippable(move, before, held.position);
}

}  // namespace counterflex
