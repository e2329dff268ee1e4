#include "program/klartext_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "counterflex/files/numbers.hpp"
#include "program/dialect.hpp"
#include "program/force_comment.hpp"
#include "program/held_position.hpp"
#include "program/number_style.hpp"

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
  Decimals decimals;
  KlartextBlock block{};
  std::vector<KlartextWord> words{};
  std::vector<KlartextChange> own{};  ///< changes inside the block

  double unit() const { return mm_per(move.unit); }
  double coordinate(const Vector3& p_mm, std::size_t axis) const {
    return p_mm[static_cast<Eigen::Index>(axis)] / unit();
  }
};

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

std::string klartext_word(const KlartextWriter& w, std::size_t axis, double value, int decimals) {
  if (std::abs(value) > 99999.9999)
    refuse_klartext(w.program.text, w.program.file, w.block, w.block.span.begin,
                    fmt::format("the corrected {} would be {}; coordinates are at most 99999.9999",
                                axis_names[axis], format_fixed(value, decimals)));
  return fmt::format("{}{}{}", w.move.relative ? "I" : "", axis_names[axis],
                     klartext_number(w.style, value, decimals));
}

/// The number of a word of the block, changed.
std::string changed_klartext(const KlartextWriter& w, Span number, double value, int decimals) {
  std::string original(part(w.program.text, number));
  const bool comma =
      original.find(',') != std::string::npos || (original.find('.') == std::string::npos && w.style.comma);
  std::erase(original, ' ');
  std::replace(original.begin(), original.end(), ',', '.');
  std::string text = changed_number(original, value, decimals);
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

/// Words that bring the tool to `point_mm`, in a line of their own; empty where the text already holds it.
std::string words_to(KlartextWriter& w, const Vector3& point_mm) {
  std::string text;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto& held = w.held.position[axis];
    if (w.move.ignored[axis] || !w.move.known_end[axis]) continue;
    const double wanted = w.coordinate(point_mm, axis);
    const int digits = w.decimals.inserted;
    if (held && rounds_to(*held / w.unit(), wanted, digits)) continue;
    if (w.move.relative && !held) continue;
    const double from = w.move.relative ? *held : 0.0;
    const double value = rounded(wanted - from / w.unit(), digits);
    text += " " + klartext_word(w, axis, value, digits);
    held = from + value * w.unit();
  }
  return text;
}

/// The centre of arcs as it is written.
Vector3 written_centre(const KlartextWriter& w, const Vector3& centre_mm,
                       const std::array<int, 2>& decimals) {
  return as_written_mm(centre_mm, w.move.unit, {decimals[0], decimals[1], 3});
}

bool same_pole(const Vector3& a, const Vector3& b) {
  return (a - b).head<2>().norm() < 1e-9;
}

std::string pole_statement(KlartextWriter& w, const Vector3& centre_mm) {
  const int digits = w.decimals.inserted;
  const Vector3 written = written_centre(w, centre_mm, {digits, digits});
  if (w.held.pole_mm && same_pole(*w.held.pole_mm, written)) return {};
  w.held.pole_mm = written;
  std::string text = "CC";
  for (std::size_t axis = 0; axis < 2; ++axis)
    text +=
        fmt::format(" {}{}", axis_names[axis], klartext_number(w.style, w.coordinate(written, axis), digits));
  return text;
}

/// The CC before the block, changed in place.
void change_pole(KlartextWriter& w, const Vector3& centre_mm) {
  const ArcMove& arc = *w.move.arc;
  Vector3 centre = arc.centre_mm;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const AxisWord& word = *arc.centre_words[axis];
    const int digits = std::max(word.decimals, w.decimals.inserted);
    const double wanted = w.coordinate(centre_mm, axis);
    if (rounds_to(w.coordinate(centre, axis), wanted, digits)) continue;
    const double value = rounded(wanted, digits);
    w.changes.push_back({word.number, changed_klartext(w, word.number, value, digits)});
    ++w.out.changed_words;
    centre[static_cast<Eigen::Index>(axis)] = value * w.unit();
  }
  std::sort(w.changes.end() - std::min<std::ptrdiff_t>(2, std::ssize(w.changes)), w.changes.end(),
            [](const KlartextChange& a, const KlartextChange& b) { return a.span.begin < b.span.begin; });
  w.held.pole_mm = centre;
}

std::string radius_word(KlartextWriter& w, const HeldPosition& start, const Vector3& centre_mm) {
  const Vector3 from(start[0].value_or(0), start[1].value_or(0), centre_mm.z());
  const double radius = (from - centre_mm).head<2>().norm() / w.unit();
  return "R" + klartext_number(w.style, radius, w.decimals.inserted);
}

/// The statements that move to one inserted point.
std::vector<std::string> statements_to(KlartextWriter& w, const Via& via, bool feed) {
  const HeldPosition start = w.held.position;
  const std::string coordinates = words_to(w, via.end_mm);
  if (coordinates.empty()) return {};
  const std::string tail = feed ? feed_of(w) : "";
  if (!via.centre_mm) return {"L" + coordinates + tail};
  const std::string sense = w.move.arc->clockwise ? " DR-" : " DR+";
  if (w.move.arc->radius_word)
    return {"CR" + coordinates + " " + radius_word(w, start, *via.centre_mm) + sense + tail};
  std::vector<std::string> statements;
  if (std::string pole = pole_statement(w, *via.centre_mm); !pole.empty()) statements.push_back(pole);
  statements.push_back("C" + coordinates + sense + tail);
  return statements;
}

void change_coordinates(KlartextWriter& w, const Vector3& end_mm) {
  Move move = w.move;
  move.block_delete = false;
  const HeldPosition before = w.held.position;
  const HeldPosition after = held_after(move, before, end_mm, w.options);
  std::string inserted;
  std::size_t behind = w.block.parts[0].begin + w.block.head.size();
  for (const KlartextWord& word : w.words)
    if (is_axis_word(word)) behind = word.span.end;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    w.held.position[axis] = after[axis];
    if (!after[axis]) continue;
    const double from =
        move.relative ? before[axis].value_or(w.move.start_mm[static_cast<Eigen::Index>(axis)]) : 0;
    const double value = (*after[axis] - from) / w.unit();
    const int digits = w.decimals.end[axis];
    if (const auto& word = move.words[axis]) {
      const double original =
          w.coordinate(move.end_mm, axis) - (move.relative ? w.coordinate(move.start_mm, axis) : 0);
      if (std::abs(value - original) < 1e-9) continue;
      w.own.push_back({word->number, changed_klartext(w, word->number, value, digits)});
      ++w.out.changed_words;
    } else if (!before[axis] || std::abs(*after[axis] - *before[axis]) > 1e-9) {
      inserted += " " + klartext_word(w, axis, value, digits);
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

void change_radius(KlartextWriter& w, const HeldPosition& start, const Vector3& centre_mm) {
  const AxisWord& word = *w.move.arc->radius_word;
  const Vector3 from(start[0].value_or(0), start[1].value_or(0), centre_mm.z());
  const Vector3 to(w.held.position[0].value_or(0), w.held.position[1].value_or(0), centre_mm.z());
  const double sweep = sweep_between(from, to, centre_mm, Vector3(0, 0, w.move.arc->clockwise ? -1 : 1));
  const double radius = (from - centre_mm).head<2>().norm() / w.unit() * (sweep > EIGEN_PI ? -1 : 1);
  const int digits = std::max(word.decimals, w.decimals.inserted);
  if (rounds_to(w.move.arc->radius_mm / w.unit(), radius, digits)) return;
  w.own.push_back({word.number, changed_klartext(w, word.number, radius, digits)});
  ++w.out.changed_words;
}

/// The block's own coordinates, and centre or radius of an arc. Returns a CC that must stand before it.
std::string change_block(KlartextWriter& w, const Vector3& end_mm, const std::optional<Vector3>& centre_mm) {
  const HeldPosition start = w.held.position;
  change_coordinates(w, end_mm);
  if (!w.move.arc) return {};
  if (!centre_mm) return make_line(w), std::string();
  if (w.move.arc->radius_word) return change_radius(w, start, *centre_mm), std::string();
  return pole_statement(w, *centre_mm);
}

void emit(KlartextWriter& w, const std::vector<std::string>& before, const std::vector<std::string>& behind) {
  std::string text;
  for (const std::string& statement : before) text += inserted_line(w, statement) + w.style.line_end;
  if (!text.empty()) w.changes.push_back({{w.block.span.begin, w.block.span.begin}, text});
  std::stable_sort(w.own.begin(), w.own.end(), [](const KlartextChange& a, const KlartextChange& b) {
    return a.span.begin < b.span.begin;
  });
  w.changes.insert(w.changes.end(), w.own.begin(), w.own.end());
  text.clear();
  for (const std::string& statement : behind) text += w.style.line_end + inserted_line(w, statement);
  if (!text.empty()) w.changes.push_back({{w.block.span.end, w.block.span.end}, text});
  w.out.inserted_blocks += before.size() + behind.size();
}

void doubt_skipped(KlartextWriter& w, const HeldPosition& before) {
  if (!w.move.block_delete) return;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (w.move.words[axis] || before[axis] != w.held.position[axis]) w.held.position[axis].reset();
}

void write_edit(KlartextWriter& w, const MoveEdit& edit) {
  std::vector<Via> stops = edit.inserted;
  stops.push_back({edit.end_mm, edit.centre_mm});
  const bool own_first = stops.size() > 1 && w.move.motion == Motion::feed && acts_itself(w);
  const std::size_t own = own_first ? 0 : stops.size() - 1;
  const auto append = [](std::vector<std::string>& to, const std::vector<std::string>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  std::vector<std::string> before, behind;
  if (edit.jump_mm) append(before, statements_to(w, {*edit.jump_mm, {}}, true));
  const auto& arc = w.move.arc;
  const bool change_in_place = arc && arc->centre_words[0] && edit.inserted.empty() && edit.centre_mm;
  if (arc && arc->centre_words[0]) w.held.pole_mm = arc->centre_mm;
  if (change_in_place) change_pole(w, *edit.centre_mm);
  for (std::size_t i = 0; i < stops.size(); ++i) {
    if (i != own) {
      append(i < own ? before : behind, statements_to(w, stops[i], i < own));
      continue;
    }
    std::optional<Vector3> centre = stops[i].centre_mm;
    if (change_in_place) centre = w.held.pole_mm;
    if (std::string pole = change_block(w, stops[i].end_mm, centre); !pole.empty()) before.push_back(pole);
  }
  emit(w, before, behind);
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
  KlartextWriter w{program, style, move, options, held, changes, out, decimals_of(move, options)};
  w.block.line_end = {move.block.begin, move.block.begin};
  w.block.last_line = move.line - 1;
  next_klartext_block(program.text, w.block);
  lex_klartext_words(program.text, program.file, w.block, w.words);
  held.position = held_at_start(move, held.position);
  const HeldPosition before = held.position;
  write_edit(w, edit);
  doubt_skipped(w, before);
}

}  // namespace counterflex
