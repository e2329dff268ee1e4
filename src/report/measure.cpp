#include "measure.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "counterflex/geometry/units.hpp"

namespace counterflex {

namespace {

constexpr double no_correction = 1e-12;  // m: rounding of coordinates that were moved to M and back
constexpr double same_place = 1e-9;      // m

struct Collector {
  Measures m;
  std::map<int, WorstRow> lines;
  std::optional<std::size_t> last_changed;
  double piece_weight = 0;  // of the piece under way: all but `after` is known at the ends of pieces alone
  std::optional<Waypoint> end;  // the last one, and what it weighs so far
  double end_weight = 0;
  std::optional<Waypoint> rapid;  // the last waypoint, where it ends a rapid

  static DeviationSample sample(const Waypoint& w, const Vector6& deviation, double weight) {
    return {deviation, w.direction, w.tool_axis, weight, w.line};
  }

  void keep(Largest& largest, double length, int line) const {
    if (largest.line == 0 || length / mm > largest.mm + 1e-12) largest.line = line;  // the first but for rounding
    largest.mm = std::max(largest.mm, length / mm);
  }

  void add_target(const Waypoint& w) {
    const double length = w.correction.head<3>().norm();
    keep(m.correction, length, w.line);
    if (length < no_correction || last_changed == w.segment) return;
    last_changed = w.segment;
    ++m.segments_changed;
  }

  // The end of a rapid is where the feed move after it starts; its force has not yet grown there.
  void begin_at_rapid(const Waypoint& w) {
    const double gap = std::abs((w.p_MT - rapid->p_MT).norm() - piece_weight);
    if (!end && gap < same_place) {
      end = *rapid;
      end->line = w.line;
      end->direction = w.direction;
      end_weight = 0;
    }
    rapid.reset();
  }

  // Trapezoids: a piece weighs on both of its ends, or on its last one alone where the other is not known.
  void add_end(const Waypoint& w) {
    if (rapid) begin_at_rapid(w);
    const double share = end ? piece_weight / 2 : 0;
    end_weight += share;
    finish_end();
    end = w;
    end_weight = piece_weight - share;
    piece_weight = 0;
  }

  void finish_end() {
    if (end) measure_end(*end, end_weight);
    end.reset();
  }

  void measure_end(const Waypoint& w, double weight) {
    m.before.add(sample(w, w.before, weight));
    m.geometry.add(sample(w, w.geometry, weight));
    m.load.add(sample(w, w.load, weight));
    m.superposition.add(sample(w, w.superposition, weight));
    keep(m.air, w.air.head<3>().norm(), w.line);
    WorstRow& row = lines[w.line];
    row.before_mm = std::max(row.before_mm, w.before.head<3>().norm() / mm);
  }

  void add_cutting(const Waypoint& w) {
    m.after.add(sample(w, w.after, w.weight));
    m.path_mm += w.weight / mm;
    m.largest_N = std::max(m.largest_N, w.wrench.head<3>().norm());
    m.largest_Nm = std::max(m.largest_Nm, w.wrench.tail<3>().norm());
    WorstRow& row = lines[w.line];
    row.line = w.line;
    row.after_mm = std::max(row.after_mm, w.after.head<3>().norm() / mm);
    piece_weight += w.weight;
    if (!w.between) add_end(w);
  }

  void add(const Waypoint& w) {
    if (w.status != Status::converged) return;
    if (!w.between) add_target(w);
    if (w.cutting) return add_cutting(w);
    finish_end();
    rapid = w;
  }
};

}  // namespace

Measures measure(const std::vector<Waypoint>& waypoints) {
  Collector collector;
  for (const Waypoint& w : waypoints) collector.add(w);
  collector.finish_end();
  for (const auto& [line, row] : collector.lines) collector.m.by_line.push_back(row);
  return std::move(collector.m);
}

}  // namespace counterflex
