#include "program/klartext/write/block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "counterflex/files/text.hpp"
#include "counterflex/program/kept_words.hpp"
#include "program/dialect.hpp"
#include "program/text/lex.hpp"
#include "program/text/number_style.hpp"
#include "program/write/step.hpp"

namespace counterflex {
namespace {

constexpr std::string_view axis_names = "XYZ";

/// A block being rewritten, lexed again, and its changes.
struct KlartextBlockWriter {
  const Program& program;
  const KlartextStyle& style;
  const Move& move;
  const WriteOptions& options;
  KlartextTextState& state;
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

/// Whether polar words give the coordinate.
bool is_polar_axis(const Move& move, std::size_t axis) {
  if (!move.polar || !move.words[axis]) return false;
  const std::size_t begin = move.words[axis]->number.begin;
  std::size_t axes = 0;
  for (const auto& word : move.words) axes += word && word->number.begin == begin;
  return axes == 2;
}

/// Whether the arc may change the words of the CC before it.
bool has_own_pole(const Move& move) {
  return move.arc && move.arc->centre_words[move.arc->normal == 0 ? 1 : 0];
}

/// Position of the pole of the arc's CC, with the tool at `position` before it.
Vector3 own_pole_mm(const Move& move, const TextPosition& position) {
  Vector3 pole = move.arc->centre_mm;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!move.arc->absolute_centre && position[axis])
      pole[static_cast<Eigen::Index>(axis)] += *position[axis] - component(move.start_mm, axis);
  return pole;
}

std::string klartext_word(const KlartextBlockWriter& w, std::size_t axis, const WordNumber& number) {
  if (std::abs(number.value) > 99999.9999)
    refuse_klartext(w.program.text, w.program.file, w.block, w.block.span.begin,
                    fmt::format("the corrected {} would be {}; coordinates are at most 99999.9999",
                                axis_names[axis], format_fixed(number.value, number.decimals)));
  return fmt::format(" {}{}{}", is_relative(w.move, axis) ? "I" : "", axis_names[axis],
                     klartext_number(w.style, number.value, number.decimals));
}

/// The changed number of a word of the block.
std::string changed_klartext(const KlartextBlockWriter& w, const AxisWord& word, const WordNumber& number) {
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
std::string inserted_line(const KlartextBlockWriter& w, const std::string& statement) {
  std::string start;
  if (!empty(w.block.block_delete)) start += "/";
  if (w.style.numbered) start += w.style.n_words ? "N0 " : "0 ";
  return start + statement;
}

/// FMAX acts in its own block only.
std::string feed_of(const KlartextBlockWriter& w, const Step& step) {
  if (step.motion == 0) return " FMAX";
  if (w.move.motion == Motion::rapid) return {};
  for (const KlartextWord& word : w.words)
    if (word.key.starts_with('F')) return " " + std::string(part(w.program.text, word.span));
  return {};
}

std::string direction_text(const Move& move) {
  return move.arc->clockwise ? " DR-" : " DR+";
}

/// CC for the centre of `arc`, if the text has another one.
void set_pole(KlartextBlockWriter& w, const ArcWords& arc, std::vector<std::string>& statements) {
  bool there = w.state.pole.centre_mm.has_value();
  std::string text = "CC";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!in_plane(*w.move.arc, axis)) continue;
    const WordNumber& number = arc.centre[axis];
    const double centre = component(arc.curve.arc->centre, axis);
    there = there && rounds_to(component(*w.state.pole.centre_mm, axis) / w.unit(), centre / w.unit(),
                               number.decimals);
    text += fmt::format(" {}{}{}", w.move.arc->absolute_centre ? "" : "I", axis_names[axis],
                        klartext_number(w.style, number.value, number.decimals));
  }
  if (there) return;
  statements.push_back(text);
  w.state.pole.centre_mm = arc.curve.arc->centre;
  w.state.pole.differs = true;
}

/// Changes the words of the CC before the block in place.
void change_pole(KlartextBlockWriter& w, const ArcWords& arc) {
  std::vector<KlartextChange> changes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!in_plane(*w.move.arc, axis) || !arc.centre[axis].write) continue;
    const AxisWord& word = *w.move.arc->centre_words[axis];
    changes.push_back({word.number, changed_klartext(w, word, arc.centre[axis])});
    ++w.out.changed_words;
  }
  sort_changes(changes);
  w.changes.insert(w.changes.end(), changes.begin(), changes.end());
  w.state.pole.differs = w.state.pole.differs || !changes.empty() || !w.move.arc->absolute_centre;
  w.state.pole.centre_mm = arc.curve.arc->centre;
}

/// The statements of an inserted piece.
void insert_step(KlartextBlockWriter& w, const Step& step, bool states_feed,
                 std::vector<std::string>& statements) {
  std::string coordinates;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (step.after[axis] && step.after[axis] != step.before[axis])
      coordinates += klartext_word(w, axis, step.axes[axis].number);
  std::string head = "L", tail;
  if (step.arc && w.move.arc->radius_word) {
    head = "CR";
    tail = " R" + klartext_number(w.style, step.arc->radius.value, step.arc->radius.decimals) +
           direction_text(w.move);
  } else if (step.arc) {
    set_pole(w, *step.arc, statements);
    head = "C";
    tail = direction_text(w.move);
  }
  statements.push_back(head + coordinates + tail + (states_feed ? feed_of(w, step) : ""));
}

/// The statement at byte `at`, with the lines that continue it, without its number.
Span statement_around(const KlartextBlockWriter& w, std::size_t at) {
  const std::string_view text = w.program.text;
  const auto begin_of_line = [&](std::size_t in) { return in == 0 ? 0 : text.rfind('\n', in - 1) + 1; };
  std::size_t begin = begin_of_line(at);
  while (begin > 0 && continues_behind(text, begin - 1)) begin = begin_of_line(begin - 1);
  KlartextBlock statement;
  statement.line_end = {begin, begin};
  next_klartext_block(text, statement);
  return {statement.parts[0].begin, statement.span.end};
}

/// The height of the surface of the hole: changed in the text if possible, or written again before the block.
void state_surface(KlartextBlockWriter& w, const WordNumber& number) {
  const AxisWord& word = *w.move.words[2];
  const double wanted = number.write ? number.value : component(w.move.end_mm, 2) / w.unit();
  const bool there = w.move.repeats_surface
                         ? rounds_to(w.state.surface.value_or(component(w.move.end_mm, 2) / w.unit()), wanted,
                                     number.decimals)
                         : !number.write;
  w.state.surface = wanted;
  if (there) return;
  ++w.out.changed_words;
  WordNumber stated = number;
  stated.value = wanted;
  const std::string changed = changed_klartext(w, word, stated);
  if (!w.move.repeats_surface) return w.own.push_back({word.number, changed});
  const Span lines = statement_around(w, word.number.begin);
  w.before.push_back(std::string(part(w.program.text, {lines.begin, word.number.begin})) + changed +
                     std::string(part(w.program.text, {word.number.end, lines.end})));
}

/// Whether the word of an axis is written before the block.
bool is_of_surface(const KlartextBlockWriter& w, std::size_t axis) {
  return axis == 2 && w.move.words[2] && w.move.words[2]->number.begin < w.block.span.begin;
}

void change_coordinates(KlartextBlockWriter& w, const Step& step) {
  std::string inserted;
  std::size_t behind = w.block.parts[0].begin + w.block.head.size();
  for (const PackedAxisWord& word : w.move.words)
    if (word && word->number.begin >= w.move.block.begin) behind = std::max(behind, word->number.end);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const WordNumber& number = step.axes[axis].number;
    if (is_of_surface(w, axis)) {
      state_surface(w, number);
      continue;
    }
    if (!number.write || is_polar_axis(w.move, axis)) continue;
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

void change_head(KlartextBlockWriter& w, const char* head) {
  const std::size_t begin = w.block.parts[0].begin;
  w.own.push_back({{begin, begin + w.block.head.size()}, head});
}

/// Removes a word and the blanks before it.
void drop_word(KlartextBlockWriter& w, const KlartextWord& word) {
  std::size_t begin = word.span.begin;
  while (begin > w.block.span.begin && w.program.text[begin - 1] == ' ') --begin;
  w.own.push_back({{begin, word.span.end}, ""});
}

/// An arc that is written as chords: its last piece is a line.
void make_line(KlartextBlockWriter& w) {
  change_head(w, "L");
  for (const KlartextWord& word : w.words)
    if (word.key == "DR" || (word.key == "R" && w.block.head == "CR")) drop_word(w, word);
}

/// Whether polar words stay: they need the pole of the original, or a pole that moves with the arc.
bool keeps_polar(const KlartextBlockWriter& w, const Step& step) {
  bool writes = false;
  for (std::size_t axis = 0; axis < 3; ++axis)
    writes = writes || (is_polar_axis(w.move, axis) && step.axes[axis].number.write);
  return !writes && (step.arc || !w.state.pole.differs);
}

/// Replaces polar words that cannot hold a correction by Cartesian ones.
void replace_polar(KlartextBlockWriter& w, const Step& step, const Vector3& wanted_mm) {
  if (step.arc || !w.move.arc) change_head(w, step.arc ? "C" : "L");
  std::string coordinates;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!is_polar_axis(w.move, axis)) continue;
    WordNumber number = step.axes[axis].number;
    if (!number.write) number.value = rounded(component(wanted_mm, axis) / w.unit(), number.decimals);
    coordinates += klartext_word(w, axis, number);
    ++w.out.changed_words;
    w.state.position[axis] = number.value * w.unit();
  }
  for (const KlartextWord& word : w.words) {
    if (!word.key.ends_with("PA") && !word.key.ends_with("PR")) continue;
    drop_word(w, word);
    w.own.back().text = std::exchange(coordinates, {});
  }
}

/// CT depends on the move before it. If that move or the end of the arc changes, a C about the same centre
/// replaces it. True if the block stays.
bool keeps_tangent(const KlartextBlockWriter& w, const Step& step) {
  bool stays = true;
  for (std::size_t axis = 0; axis < 3; ++axis)
    stays = stays && !step.axes[axis].number.write && step.before[axis] == component(w.move.start_mm, axis);
  return stays;
}

void make_arc_of_tangent(KlartextBlockWriter& w, const ArcWords& arc) {
  change_head(w, "C");
  set_pole(w, arc, w.before);
  std::size_t behind = 0;
  for (const PackedAxisWord& word : w.move.words)
    if (word) behind = std::max(behind, word->number.end);
  w.own.push_back({{behind, behind}, direction_text(w.move)});
}

/// The coordinates of the block, and centre or radius of an arc.
void change_block(KlartextBlockWriter& w, const Step& step, const Vector3& wanted_mm, bool pole_is_own) {
  change_coordinates(w, step);
  if (w.move.polar && !keeps_polar(w, step)) replace_polar(w, step, wanted_mm);
  if (!w.move.arc) return;
  if (step.motion == 1) return make_line(w);
  if (!step.arc) return;
  if (w.block.head == "CT") {
    if (!keeps_tangent(w, step)) make_arc_of_tangent(w, *step.arc);
    return;
  }
  if (!w.move.arc->radius_word)
    return pole_is_own ? change_pole(w, *step.arc) : set_pole(w, *step.arc, w.before);
  if (!step.arc->radius.write) return;
  const AxisWord& word = *w.move.arc->radius_word;
  w.own.push_back({word.number, changed_klartext(w, word, step.arc->radius)});
  ++w.out.changed_words;
}

/// Appends the changes before, in and behind the block to the list of changes.
void emit(KlartextBlockWriter& w) {
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

/// A point of an edit, and the curve to it.
struct KlartextStop {
  Via via;
  int motion;
};

std::vector<KlartextStop> stops_of(const Move& move, const MoveEdit& edit) {
  std::vector<KlartextStop> stops;
  if (edit.jump) stops.push_back({*edit.jump, 1});
  for (const Via& via : edit.inserted) stops.push_back({via, motion_of(move)});
  stops.push_back({{edit.end_mm, edit.centre_mm}, motion_of(move)});
  return stops;
}

void write_edit(KlartextBlockWriter& w, const MoveEdit& edit) {
  const std::vector<KlartextStop> stops = stops_of(w.move, edit);
  const bool own_first = stops.size() > 1 && is_first_piece(w.move, kept_words(w.program, w.move));
  const std::size_t own = own_first ? 0 : stops.size() - 1;
  const bool has_pole = has_own_pole(w.move);
  if (has_pole) w.state.pole.centre_mm = own_pole_mm(w.move, w.state.position);
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const bool end = i + 1 == stops.size();
    const Place place = end ? Place::end : i == own ? Place::own_inside : Place::inside;
    const Step step = round_step(w.move, w.state.position, stops[i].via, stops[i].motion, place, w.options);
    w.state.position = step.after;
    if (i == own)
      change_block(w, step, stops[i].via.end_mm, has_pole && w.before.empty());
    else if (!equals_text_position(step))
      insert_step(w, step, i < own, i < own ? w.before : w.behind);
  }
  emit(w);
}

bool has_words(const Move& move) {
  return move.words[0] || move.words[1] || move.words[2];
}

}  // namespace

void reach_surface(const Move& move, KlartextTextState& state) {
  const bool of_cycle = move.makes_hole && move.takes_no_z && !move.words[2] && move.known_end[2];
  if (of_cycle) state.position[2] = state.surface ? *state.surface * mm_per(move.unit) : move.end_mm.z();
}

void rewrite_klartext_block(const Program& program, const KlartextStyle& style, const MoveEdit& edit,
                            const WriteOptions& options, KlartextTextState& state,
                            std::vector<KlartextChange>& changes, Rewritten& out) {
  const Move& move = program.moves[edit.move];
  assert(edit.inserted.empty() || move.may_split || move.may_position || changes_height_inside(move));
  if (!has_words(move)) {
    state.position = text_position_after_original(move, state.position);
    return reach_surface(move, state);
  }
  KlartextBlockWriter w{program, style, move, options, state, changes, out};
  w.block.line_end = {move.block.begin, move.block.begin};
  w.block.last_line = move.line - 1;
  next_klartext_block(program.text, w.block);
  // CYCL CALL or M99 without coordinates: the word is in the cycle's definition.
  const bool calls_cycle = w.block.head == "CYCL" || w.block.head.starts_with('M');
  if (!calls_cycle) lex_klartext_words(program.text, program.file, w.block, w.words);
  state.position = known_text_position(move, state.position);
  const TextPosition before = state.position;
  write_edit(w, edit);
  forget_skippable(move, before, state.position);
  reach_surface(move, state);
}

}  // namespace counterflex
