#pragma once
/// An independent reader of plain G-code for tests: it shares no code, and so no errors, with the writer. No
/// comments, no offsets; every position is known once it is programmed.
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/curve.hpp"
#include "counterflex/program/program.hpp"

namespace counterflex::test {

struct SmallState {
  int motion = -1, normal = 2;
  bool relative = false, absolute_centre = false, inverse_time = false, to_retract = false;
  double unit = 1, feed = 0;
  std::array<bool, 3> known{};
  Vector3 position = Vector3::Zero();
  double bottom = 0, retract = 0, initial = 0;
};

struct SmallWord {
  double value;
  AxisWord at;
};

inline std::multimap<char, SmallWord> small_words(const std::string& text, std::size_t begin,
                                                  std::size_t end) {
  std::multimap<char, SmallWord> words;
  for (std::size_t i = begin; i < end && text[i] != '(';) {
    const char letter = static_cast<char>(text[i++] & ~0x20);
    if (letter < 'A' || letter > 'Z') continue;
    const std::size_t number = i;
    while (i < end && std::string_view("+-.0123456789").find(text[i]) != std::string_view::npos) ++i;
    const std::string shown = text.substr(number, i - number);
    const std::size_t point = shown.find('.');
    const int decimals = point == std::string::npos ? 0 : static_cast<int>(shown.size() - point - 1);
    words.insert({letter, {*read_number(shown), {{number, i}, decimals}}});
  }
  return words;
}

inline void small_modes(const std::multimap<char, SmallWord>& words, SmallState& s) {
  const auto [first, last] = words.equal_range('G');
  for (auto g = first; g != last; ++g) {
    const double code = g->second.value;
    if (code <= 3 || (code >= 80 && code <= 89)) s.motion = static_cast<int>(code);
    if (code == 20) s.unit = 25.4;
    if (code == 21) s.unit = 1;
    if (code >= 17 && code <= 19) s.normal = 19 - static_cast<int>(code);
    if (code == 90 || code == 91) s.relative = code == 91;
    if (code == 90.1 || code == 91.1) s.absolute_centre = code == 90.1;
    if (code == 93 || code == 94) s.inverse_time = code == 93;
    if (code == 98 || code == 99) s.to_retract = code == 99;
  }
  if (const auto f = words.find('F'); f != words.end()) s.feed = f->second.value;
}

/// The centre by rotating the direction of the chord, as LinuxCNC's interpreter does.
inline Vector3 small_centre(const Vector3& start, const Vector3& end, double radius, const ArcMove& arc) {
  const int a = (arc.normal + 1) % 3, b = (arc.normal + 2) % 3;
  const double u = end[a] - start[a], v = end[b] - start[b];
  const double half = std::hypot(u, v) / 2, size = std::abs(radius);
  const bool left = arc.clockwise == (radius < 0);
  const double theta = std::atan2(v, u) + (left ? 0.5 : -0.5) * std::numbers::pi;
  const double offset = size * std::cos(std::asin(std::fmin(1, half / size)));
  Vector3 centre = start;
  centre[a] = (start[a] + end[a]) / 2 + offset * std::cos(theta);
  centre[b] = (start[b] + end[b]) / 2 + offset * std::sin(theta);
  return centre;
}

inline void small_arc(const std::multimap<char, SmallWord>& words, const SmallState& s, Move& move) {
  ArcMove& arc = move.arc.emplace();
  arc.normal = s.normal;
  arc.clockwise = s.motion == 2;
  arc.absolute_centre = s.absolute_centre;
  arc.centre_mm = move.start_mm;
  for (int axis = 0; axis < 3; ++axis) {
    const auto word = words.find(static_cast<char>('I' + axis));
    if (word == words.end()) continue;
    arc.centre_words[static_cast<std::size_t>(axis)] = word->second.at;
    arc.centre_mm[axis] = (s.absolute_centre ? 0 : move.start_mm[axis]) + word->second.value * s.unit;
  }
  if (const auto r = words.find('R'); r != words.end()) {
    arc.radius_word = r->second.at;
    arc.radius_mm = r->second.value * s.unit;
    arc.centre_mm = small_centre(move.start_mm, move.end_mm, arc.radius_mm, arc);
  }
  if (const auto p = words.find('P'); p != words.end()) arc.turns = static_cast<int>(p->second.value) - 1;
}

inline void small_cycle(const std::multimap<char, SmallWord>& words, bool first, SmallState& s, Move& move) {
  CycleMove& cycle = move.cycle.emplace();
  if (const auto r = words.find('R'); r != words.end()) {
    cycle.retract_word = r->second.at;
    s.retract = (s.relative ? move.start_mm.z() : 0) + r->second.value * s.unit;
  }
  if (const auto z = words.find('Z'); z != words.end()) {
    cycle.bottom_word = z->second.at;
    s.bottom = (s.relative ? s.retract : 0) + z->second.value * s.unit;
  }
  if (first) s.initial = move.start_mm.z();
  cycle.first = cycle.begins_series = first;
  cycle.initial_mm = s.initial;
  cycle.bottom_mm = s.bottom;
  cycle.retract_mm = s.retract;
  cycle.returns_to_retract = s.to_retract;
  move.words[2].reset();
  move.end_mm.z() = s.to_retract ? s.retract : std::fmax(s.retract, s.initial);
}

inline void small_move(const std::multimap<char, SmallWord>& words, SmallState& s, Move& move) {
  move.known_start = s.known;
  move.start_mm = move.end_mm = s.position;
  move.unit = s.unit == 1 ? LengthUnit::millimetres : LengthUnit::inches;
  move.relative = s.relative;
  move.motion = s.motion == 0 ? Motion::rapid : Motion::feed;
  for (int axis = 0; axis < 3; ++axis) {
    const auto word = words.find(static_cast<char>('X' + axis));
    if (word == words.end()) continue;
    move.words[static_cast<std::size_t>(axis)] = word->second.at;
    move.end_mm[axis] = (s.relative ? s.position[axis] : 0) + word->second.value * s.unit;
    s.known[static_cast<std::size_t>(axis)] = true;
  }
  if (s.motion == 2 || s.motion == 3) small_arc(words, s, move);
  if (s.motion >= 80) small_cycle(words, words.contains('G'), s, move);
  move.feed_mode = s.inverse_time ? FeedMode::inverse_time : FeedMode::length;
  move.feed_per_min = s.inverse_time ? s.feed : 0;
  move.feed_mm_min = s.feed;
  move.known_end = s.known;
  move.may_split = s.motion > 0 && s.motion < 80;
  move.may_jump = s.motion < 80;
  s.position = move.end_mm;
}

inline Program read_small(const std::string& text, const std::string& dialect = "linuxcnc") {
  Program program;
  program.file = "p.ngc";
  program.text = text;
  program.dialect = dialect;
  SmallState s;
  int line = 0;
  for (std::size_t begin = 0; begin < text.size(); begin = text.find('\n', begin) + 1) {
    const std::size_t end = text.find('\n', begin);
    const auto words = small_words(text, begin, end);
    ++line;
    small_modes(words, s);
    bool moves = false;
    for (const char letter : std::string_view("XYZIJKR")) moves = moves || words.contains(letter);
    if (!moves) continue;
    Move& move = program.moves.emplace_back();
    move.line = line;
    move.block = {begin, end};
    small_move(words, s, move);
    if (text[begin] != '/') continue;
    move.block_delete = true;
    for (std::size_t axis = 0; axis < 3; ++axis) s.known[axis] = s.known[axis] && !move.words[axis];
  }
  return program;
}

/// The path of a move.
inline Curve way_of(const Move& move) {
  Curve curve{move.start_mm, move.end_mm, {}};
  if (!move.arc) return curve;
  const Vector3 normal = (move.arc->clockwise ? -1 : 1) * Vector3::Unit(move.arc->normal);
  curve.arc = Arc{move.arc->centre_mm, normal,
                  sweep_between(move.start_mm, move.end_mm, move.arc->centre_mm, normal, move.arc->turns)};
  return curve;
}

}  // namespace counterflex::test
