// What is kept of a window comes back as it was, to the last bit.
#include "window_record.hpp"

#include <random>

#include "compensation/gantry.hpp"
#include "compensation/parts.hpp"
#include "counterflex/files/bytes.hpp"
#include "waypoint_bytes.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// Numbers of all kinds, those without a value among them.
class AnyNumbers {
 public:
  explicit AnyNumbers(unsigned seed) : random_(seed) {}

  double number() { return std::bit_cast<double>(random_()); }
  bool flag() { return random_() % 2 == 0; }
  int integer() { return static_cast<int>(random_()); }
  std::optional<double> perhaps() { return flag() ? std::optional(number()) : std::nullopt; }
  Status status() { return static_cast<Status>(random_() % 6); }

  template <typename Vector>
  void fill(Vector& vector) {
    for (double& x : vector) x = number();
  }

 private:
  std::mt19937_64 random_;
};

Waypoint any_waypoint(AnyNumbers& any) {
  Waypoint w;
  w.segment = any.flag() ? no_segment : static_cast<std::size_t>(any.integer());
  w.fraction = any.number();
  w.line = any.integer();
  w.cutting = any.flag();
  w.between = any.flag();
  w.place = any.flag();
  w.exempt = any.flag();
  w.weight = any.number();
  w.s = any.number();
  for (Vector3* v : {&w.p_MT, &w.direction, &w.tool_axis}) any.fill(*v);
  for (Vector6* v : {&w.wrench, &w.before, &w.after, &w.correction}) any.fill(*v);
  w.status = any.status();
  w.iterations = any.integer();
  if (any.flag()) return w;
  Causes& c = w.causes.emplace();
  for (Vector6* v :
       {&c.geometry, &c.load, &c.gravity, &c.superposition, &c.air, &c.higher.deviation, &c.lower.deviation})
    any.fill(*v);
  c.higher.status = any.status();
  c.lower.status = any.status();
  return w;
}

HeldPosition any_held(AnyNumbers& any) {
  HeldPosition held;
  for (std::optional<double>& axis : held) axis = any.perhaps();
  held.cycle_initial_mm = any.perhaps();
  return held;
}

WindowState any_state(AnyNumbers& any) {
  WindowState state;
  any.fill(state.emitter.correction);
  state.emitter.correction_known = any.flag();
  for (bool& holds : state.emitter.holds) holds = any.flag();
  state.emitter.doubtful = any.flag();
  state.emitter.group = any.integer();
  state.emitter.held = any_held(any);
  state.text.held = any_held(any);
  state.text.cycle = {any.number(), any.number()};
  if (any.flag()) state.text.restate_motion = any.integer();
  if (any.flag()) any.fill(state.command.emplace());
  return state;
}

std::string bytes_of_state(const WindowState& state) {
  std::string bytes;
  put_window_state(state, bytes);
  return bytes;
}

}  // namespace

TEST_CASE("waypoints come back from their bytes with all of their bits") {
  AnyNumbers any(7);
  std::vector<Waypoint> waypoints(3);
  waypoints[1].after[2] = -0.0;
  for (int i = 0; i < 200; ++i) {
    waypoints.push_back(any_waypoint(any));
    if (i % 3 == 0) waypoints.push_back(waypoints.back());
  }
  std::string bytes;
  put_waypoints(waypoints, bytes);
  BytesIn in(bytes);
  const std::vector<Waypoint> again = get_waypoints(in);
  CHECK(in.is_complete());
  REQUIRE(again.size() == waypoints.size());
  for (std::size_t i = 0; i < again.size(); ++i) CHECK(same_waypoint(again[i], waypoints[i]));
}

TEST_CASE("a record comes back from its bytes with all that it has of a window") {
  AnyNumbers any(11);
  WindowRecord record{.index = 7, .bytes = 4711, .start = "abc", .commands = "def"};
  record.entry = any_state(any);
  record.exit = any_state(any);
  Compensation& result = record.result;
  result.text = std::string("G1 X1\0\n", 7);
  result.waypoints.push_back(any_waypoint(any));
  result.left_alone = {{3, "why", true, 4}, {5, "", false, 0}};
  result.counts.changed_words = 1;
  result.counts.inserted_words = 2;
  result.counts.inserted_blocks = 3;
  result.corrected_moves = 4;
  result.other_moves = {5, 6, 7, 8};
  result.largest_correction = any.number();
  result.largest_correction_line = 9;
  const std::string bytes = to_bytes(record);
  const auto again = window_record_of(bytes);
  REQUIRE(again);
  CHECK(to_bytes(*again) == bytes);
  CHECK(again->index == 7);
  CHECK(again->bytes == 4711);
  CHECK(again->start + again->commands == "abcdef");
  CHECK(bytes_of_state(again->entry) == bytes_of_state(record.entry));
  CHECK(bytes_of_state(again->exit) == bytes_of_state(record.exit));
  CHECK(again->result.text == result.text);
  CHECK(same_waypoint(again->result.waypoints.at(0), result.waypoints[0]));
  REQUIRE(again->result.left_alone.size() == 2);
  CHECK(again->result.left_alone[0].why == "why");
  CHECK(again->result.left_alone[0].machine_position);
  CHECK(again->result.left_alone[0].text_line == 4);
  CHECK(again->result.left_alone[1].line == 5);
  CHECK(again->result.counts.inserted_blocks == 3);
  CHECK(again->result.other_moves.in_part == 7);
  CHECK(same_bits(again->result.largest_correction, result.largest_correction));
  CHECK(again->result.largest_correction_line == 9);
}

TEST_CASE("states of windows are the same only where all of them is") {
  const auto same = [](const WindowState& a, const WindowState& b) { return same_for({}, a, b); };
  AnyNumbers any(13);
  std::size_t alike = 0;
  for (int i = 0; i < 50; ++i) {
    const WindowState state = any_state(any);
    CHECK(same(state, state));
    alike += same(state, any_state(any));
    WindowState zero;
    zero.emitter.correction.y() = -0.0;
    CHECK_FALSE(same(zero, {}));
  }
  CHECK(alike == 0);
}

TEST_CASE("what neither a hole nor a contour of a window asks for it passes on") {
  Program window;
  window.moves.emplace_back();
  WindowState then, now;
  then.emitter.group = 3;
  then.text.cycle.bottom_change_mm = 0.25;
  then.text.held.cycle_initial_mm = then.emitter.held.cycle_initial_mm = 5;
  now.emitter.group = 4;
  now.text.held.cycle_initial_mm = now.emitter.held.cycle_initial_mm = 6;
  CHECK(same_for(unread_by(window, then, now), then, now));
  CHECK(bytes_of_state(exit_of(window, now, then)) == bytes_of_state(now));
  window.moves[0].group = 4;
  CHECK_FALSE(same_for(unread_by(window, then, now), then, now));
  window.moves[0].group = 5;
  CHECK(same_for(unread_by(window, then, now), then, now));
  CHECK(exit_of(window, now, then).emitter.group == 3);
  window.moves[0].cycle = CycleMove{};
  CHECK_FALSE(same_for(unread_by(window, then, now), then, now));
  now.emitter.held.cycle_initial_mm.reset();
  window.moves[0].cycle.reset();
  CHECK_FALSE(same_for(unread_by(window, then, now), then, now));
}

TEST_CASE("holes and contours long before a part do not keep it from being taken over") {
  std::string text =
      "G21 G90 G17\nG0 X1 Y1 Z5\nG81 G98 X2.1 Y2 Z-3 R1 F100\nX4\nX6 Y4\nG80\nG0 X0 Y0\n"
      "G41 D1 G1 X6 Y-4 F400\nX15\nY3\nX6\nY-4\nG40 X5 Y-5\nG0 Z1\nG1 F500\n";
  for (int k = 0; k < 200; ++k)
    text += fmt::format("X{} Y{}{}\n", 1 + k % 20, 0.5 * (k % 3), k == 40 ? " Z0.9" : "");
  const Split split{{.machine = rigid_gantry("0.5, -0.25, 0.125", 0.001, 0.0005), .text = text}};
  const Folder folder;
  const Taken taken = take_over(split, record(split, 3, folder));
  check_same_run(taken.run, take_over(split, {}).run);
  CHECK_FALSE(taken.run.failure);
  CHECK(taken.compensated == 0);
  CHECK(taken.taken > 8);
}
