#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "counterflex/geometry/types.hpp"
#include "forces/path/profile/log_matching.hpp"
#include "forces/path/profile/point_grid.hpp"
#include "forces/read/csv_header.hpp"

using namespace counterflex;

namespace {

using Rows = std::vector<std::vector<Visit>>;

/// A choice of visits: their sum, then path lengths that decide between equal sums.
struct Choice {
  double sum = 0;
  std::vector<double> s;
};

/// The end first, the earliest before others; then row by row upwards, the latest before others.
bool is_better(const Choice& a, const Choice& b) {
  if (a.sum != b.sum) return a.sum < b.sum;
  if (a.s.back() != b.s.back()) return a.s.back() < b.s.back();
  return std::lexicographical_compare(b.s.rbegin(), b.s.rend(), a.s.rbegin(), a.s.rend());
}

/// The best of all ordered choices that begin with `begun`, if any.
std::optional<Choice> best_of_all(const Rows& rows, const Choice& begun = {}) {
  if (begun.s.size() == rows.size()) return begun;
  std::optional<Choice> best;
  for (const Visit& visit : rows[begun.s.size()]) {
    if (!begun.s.empty() && visit.s < begun.s.back()) continue;
    Choice longer = begun;
    longer.sum += visit.squared;
    longer.s.push_back(visit.s);
    const auto found = best_of_all(rows, longer);
    if (found && (!best || is_better(*found, *best))) best = found;
  }
  return best;
}

double distance_mm(const Vector3& a, const Vector3& b, const Vector3& p) {
  const Vector3 way = b - a;
  const double u = std::clamp(way.dot(p - a) / way.squaredNorm(), 0.0, 1.0);
  return (a + u * way - p).norm() / mm;
}

}  // namespace

TEST_CASE("of visits with equal sums the one is chosen that ends earliest with the closest rows") {
  // one row that the path passes three times; then one that it passes twice, before and after a third
  CHECK(in_order({{{2, 0.25}, {6, 0.25}, {9, 0.25}}}, 1).s == std::vector<double>{2});
  CHECK(in_order({{{2, 0.25}, {6, 0.25}}, {{9, 0}}}, 1).s == std::vector<double>{6, 9});
  CHECK(in_order({{{2, 0.25}, {6, 0.25}}, {{4, 0.5}, {9, 0.5}}}, 1).s == std::vector<double>{2, 4});
  // the sum comes first
  CHECK(in_order({{{2, 0}, {6, 0.25}}, {{4, 0.5}, {9, 0.25}}}, 1).s == std::vector<double>{2, 9});
}

TEST_CASE("the chosen visits equal the result of an exhaustive search") {
  std::mt19937 random(11);
  const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
  int in_vain = 0;
  for (int run = 0; run < 300; ++run) {
    CAPTURE(run);
    Rows rows(static_cast<std::size_t>(1 + below(5)));
    for (auto& row : rows)
      for (double s = 2 * below(4); row.empty() || (row.size() < 4 && s < 20); s += 2 * (1 + below(4)))
        row.push_back({s, 0.25 * below(3)});
    const OrderedPlaces places = in_order(rows, 1);
    const auto expected = best_of_all(rows);
    CHECK(places.stuck.has_value() == !expected.has_value());
    if (expected) CHECK(places.s == expected->s);
    in_vain += !expected;
  }
  CHECK(in_vain > 0);
  CHECK(in_vain < 100);
}

TEST_CASE("the result of a grid includes all near points, each once") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> within_box(-0.02, 0.02), beside(-0.03, 0.03), step(-1, 1);
  std::vector<Vector3> points;
  for (int i = 0; i < 20000; ++i)
    points.emplace_back(within_box(random), within_box(random), within_box(random));
  PointGrid grid(points, 1 * mm);
  std::size_t near = 0, given = 0;
  for (int piece = 0; piece < 500; ++piece) {
    CAPTURE(piece);
    const Vector3 a(beside(random), beside(random), beside(random));
    const Vector3 b = a + grid.cell() / 2 * Vector3(step(random), step(random), step(random));
    std::vector<std::uint32_t> found = grid.near(a, b);
    std::sort(found.begin(), found.end());
    CHECK(std::adjacent_find(found.begin(), found.end()) == found.end());
    std::size_t missing = 0;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const bool is_near = distance_mm(a, b, points[i]) <= 1;
      near += is_near;
      missing += is_near && !std::binary_search(found.begin(), found.end(), i);
    }
    CHECK(missing == 0);
    given += found.size();
  }
  CHECK(near > 300);
  CHECK(given < 500 * points.size() / 20);
}

TEST_CASE("a point where cells meet, or at the limit, is found from every side") {
  const Vector3 corner(4 * mm, -4 * mm, 0);
  PointGrid grid({corner, {0.1, 0.1, 0.1}}, 1 * mm);
  for (const Vector3& way : {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1)})
    for (const double side : {-0.999 * mm, 0.999 * mm}) {
      const Vector3 a = corner + side * way, b = corner + 3 * side * way;
      CHECK(grid.near(a, b) == std::vector<std::uint32_t>{0});
    }
}

TEST_CASE("every key of a profile has a name for messages, also a logged position") {
  CHECK(csv::key_name(ForceKey::line) == "line");
  CHECK(csv::key_name(ForceKey::time) == "t_s");
  CHECK(csv::key_name(ForceKey::point) == "x_mm, y_mm, z_mm");
}
