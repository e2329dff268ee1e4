#include "waypoint_bytes.hpp"

#include <array>
#include <bit>

#include "counterflex/files/bytes.hpp"

namespace counterflex {
namespace {

static_assert(sizeof(Waypoint) == 336 && sizeof(Causes) == 368,
              "what is added to a waypoint is to be kept, too");

// The numbers of a waypoint, as many as there are bits in a mask: most are those of the one before it.
constexpr std::size_t numbers_of_waypoint = 36, numbers_of_causes = 42;
template <std::size_t count>
using Numbers = std::array<double, count>;

// The same list of members serves both ways.
template <typename Place, typename Take>
void each_number(Place& w, const Take& take) {
  take(w.fraction);
  take(w.weight);
  take(w.s);
  for (auto* v : {&w.p_MT, &w.direction, &w.tool_axis})
    for (auto& x : *v) take(x);
  for (auto* v : {&w.wrench, &w.before, &w.after, &w.correction})
    for (auto& x : *v) take(x);
}

template <typename Split, typename Take>
void each_cause(Split& c, const Take& take) {
  for (auto* v :
       {&c.geometry, &c.load, &c.gravity, &c.superposition, &c.air, &c.higher.deviation, &c.lower.deviation})
    for (auto& x : *v) take(x);
}

template <std::size_t count>
void put_changes(const Numbers<count>& numbers, Numbers<count>& last, std::string& bytes) {
  std::uint64_t changed = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (std::bit_cast<std::uint64_t>(numbers[i]) != std::bit_cast<std::uint64_t>(last[i]))
      changed |= std::uint64_t{1} << i;
  put(changed, bytes);
  for (std::size_t i = 0; i < count; ++i)
    if ((changed >> i & 1) != 0) put(numbers[i], bytes);
  last = numbers;
}

template <std::size_t count>
void get_changes(BytesIn& bytes, Numbers<count>& last) {
  const auto changed = bytes.get<std::uint64_t>();
  for (std::size_t i = 0; i < count; ++i)
    if ((changed >> i & 1) != 0) last[i] = bytes.get<double>();
}

// What the numbers of a waypoint are told by.
struct LastNumbers {
  Numbers<numbers_of_waypoint> place{};
  Numbers<numbers_of_causes> causes{};
};

void put_waypoint(const Waypoint& w, LastNumbers& last, std::string& bytes) {
  put(w.segment, bytes);
  put(w.line, bytes);
  put(w.corrected_line, bytes);
  put(w.iterations, bytes);
  put(w.status, bytes);
  for (const bool flag : {w.cutting, w.between, w.place, w.exempt, w.causes.has_value()}) put(flag, bytes);
  Numbers<numbers_of_waypoint> numbers;
  std::size_t i = 0;
  each_number(w, [&](const double& x) { numbers[i++] = x; });
  put_changes(numbers, last.place, bytes);
  if (!w.causes) return;
  Numbers<numbers_of_causes> causes;
  i = 0;
  each_cause(*w.causes, [&](const double& x) { causes[i++] = x; });
  put_changes(causes, last.causes, bytes);
  put(w.causes->higher.status, bytes);
  put(w.causes->lower.status, bytes);
}

void get_waypoint(BytesIn& bytes, LastNumbers& last, Waypoint& w) {
  w.segment = bytes.get<std::size_t>();
  w.line = bytes.get<int>();
  w.corrected_line = bytes.get<int>();
  w.iterations = bytes.get<int>();
  w.status = bytes.get<Status>();
  for (bool* flag : {&w.cutting, &w.between, &w.place, &w.exempt}) *flag = bytes.get<bool>();
  const bool has_causes = bytes.get<bool>();
  get_changes(bytes, last.place);
  std::size_t i = 0;
  each_number(w, [&](double& x) { x = last.place[i++]; });
  if (!has_causes) return;
  get_changes(bytes, last.causes);
  Causes& causes = w.causes.emplace();
  i = 0;
  each_cause(causes, [&](double& x) { x = last.causes[i++]; });
  causes.higher.status = bytes.get<Status>();
  causes.lower.status = bytes.get<Status>();
}

}  // namespace

void put_waypoints(const std::vector<Waypoint>& waypoints, std::string& bytes) {
  put(waypoints.size(), bytes);
  LastNumbers last;
  for (const Waypoint& w : waypoints) put_waypoint(w, last, bytes);
}

std::vector<Waypoint> get_waypoints(BytesIn& bytes) {
  constexpr std::size_t least_bytes = 33;
  std::vector<Waypoint> waypoints(bytes.get_count(least_bytes));
  LastNumbers last;
  for (Waypoint& w : waypoints) get_waypoint(bytes, last, w);
  return waypoints;
}

}  // namespace counterflex
