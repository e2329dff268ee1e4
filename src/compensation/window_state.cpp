#include "window_state.hpp"

#include <algorithm>

#include "counterflex/files/bytes.hpp"
#include "counterflex/files/files.hpp"
#include "vector_bytes.hpp"

namespace counterflex {
namespace {

static_assert(sizeof(CarriedState) == 288 && sizeof(EmitterState) == 104 && sizeof(TextState) == 184,
              "what is carried from window to window besides is to be compared and restored, too");

void put_held(const HeldPosition& held, std::string& bytes) {
  for (const std::optional<double>& axis : held) put_optional(axis, bytes);
  put_optional(held.cycle_initial_mm, bytes);
}

HeldPosition get_held(BytesIn& bytes) {
  HeldPosition held;
  for (std::optional<double>& axis : held) axis = get_optional<double>(bytes);
  held.cycle_initial_mm = get_optional<double>(bytes);
  return held;
}

void put_point(const std::optional<Vector3>& point, std::string& bytes) {
  put(point.has_value(), bytes);
  if (point) put_vector(*point, bytes);
}

std::optional<Vector3> get_point(BytesIn& bytes) {
  if (!bytes.get<bool>()) return std::nullopt;
  return get_vector<3>(bytes);
}

void put_text(const TextState& state, std::string& bytes) {
  put_held(state.held, bytes);
  put(state.cycle.bottom_change_mm, bytes);
  put(state.cycle.retract_change_mm, bytes);
  put_optional(state.restate_motion, bytes);
  put_point(state.pole.centre_mm, bytes);
  put(state.pole.differs, bytes);
  put_optional(state.surface, bytes);
  put(state.call.line, bytes);
  put(state.call.shift_mm, bytes);
  put_optional(state.numbers.last, bytes);
  put(state.numbers.renumbers, bytes);
  put(state.numbers.ended, bytes);
}

TextState get_text(BytesIn& bytes) {
  TextState state;
  state.held = get_held(bytes);
  state.cycle.bottom_change_mm = bytes.get<double>();
  state.cycle.retract_change_mm = bytes.get<double>();
  state.restate_motion = get_optional<int>(bytes);
  state.pole.centre_mm = get_point(bytes);
  state.pole.differs = bytes.get<bool>();
  state.surface = get_optional<double>(bytes);
  state.call.line = bytes.get<int>();
  state.call.shift_mm = bytes.get<double>();
  state.numbers.last = get_optional<unsigned long>(bytes);
  state.numbers.renumbers = bytes.get<bool>();
  state.numbers.ended = bytes.get<bool>();
  return state;
}

void put_emitter(const EmitterState& state, std::string& bytes) {
  put_vector(state.correction, bytes);
  put(state.correction_known, bytes);
  for (const bool holds : state.holds) put(holds, bytes);
  put(state.doubtful, bytes);
  put(state.group, bytes);
  put_held(state.held, bytes);
}

EmitterState get_emitter(BytesIn& bytes) {
  EmitterState state;
  state.correction = get_vector<3>(bytes);
  state.correction_known = bytes.get<bool>();
  for (bool& holds : state.holds) holds = bytes.get<bool>();
  state.doubtful = bytes.get<bool>();
  state.group = bytes.get<int>();
  state.held = get_held(bytes);
  return state;
}

// Of heights at which a series of cycles has begun only whether there is one: where the tool's length changes
// it is forgotten.
void blank_cycles(WindowState& state) {
  state.text.cycle = {};
  for (HeldPosition* held : {&state.emitter.held, &state.text.held})
    if (held->cycle_initial_mm) held->cycle_initial_mm = 0;
}

std::string compared(WindowState state, const Unread& unread) {
  if (unread.cycles) blank_cycles(state);
  if (unread.group) state.emitter.group = 0;
  std::string bytes;
  put_window_state(state, bytes);
  return bytes;
}

bool has_cycles(const Program& window) {
  return std::ranges::any_of(window.moves, [](const Move& move) { return move.cycle.has_value(); });
}

bool has_group(const Program& window, int group) {
  return group != 0 && std::ranges::any_of(window.moves, [&](const Move& m) { return m.group == group; });
}

bool has_groups(const Program& window) {
  return std::ranges::any_of(window.moves, [](const Move& move) { return move.group != 0; });
}

}  // namespace

WindowState state_of(const CarriedState& carried) {
  return {carried.emitter, carried.rewriter.state(), carried.command};
}

void go_on(const Program& window, const WindowState& state, CarriedState& carried) {
  carried.emitter = state.emitter;
  carried.rewriter.pass(window, state.text);
  carried.command = state.command;
}

Unread unread_by(const Program& window, const WindowState& a, const WindowState& b) {
  return {!has_cycles(window), !has_group(window, a.emitter.group) && !has_group(window, b.emitter.group)};
}

bool same_for(const Unread& unread, const WindowState& a, const WindowState& b) {
  return compared(a, unread) == compared(b, unread);
}

WindowState exit_of(const Program& window, const WindowState& entry, const WindowState& exit_then) {
  WindowState exit = exit_then;
  if (!has_groups(window)) exit.emitter.group = entry.emitter.group;
  if (has_cycles(window)) return exit;
  exit.text.cycle = entry.text.cycle;
  const auto pass_on = [](const HeldPosition& from, HeldPosition& to) {
    if (to.cycle_initial_mm) to.cycle_initial_mm = from.cycle_initial_mm;
  };
  pass_on(entry.emitter.held, exit.emitter.held);
  pass_on(entry.text.held, exit.text.held);
  return exit;
}

void put_window_state(const WindowState& state, std::string& bytes) {
  put_emitter(state.emitter, bytes);
  put_text(state.text, bytes);
  put_point(state.command, bytes);
}

WindowState get_window_state(BytesIn& bytes) {
  WindowState state;
  state.emitter = get_emitter(bytes);
  state.text = get_text(bytes);
  state.command = get_point(bytes);
  return state;
}

}  // namespace counterflex
