/// Short lines: what happens between their ends is within the bounds of their cell.
#include "statics/kernel/cells/offset_bounds.hpp"
#include "statics/support/batch_support.hpp"

using namespace counterflex;
using namespace counterflex::laws;

namespace {

struct LoadedLine {
  BatchRequest begin, end;
  Vector6 kink;  ///< of the load, in the middle
};

/// Lines up to an eighth of a cell, with loads that change along them. `crosses`: half of it is in another
/// cell, which shares a face.
LoadedLine some_line(const BatchBench& bench, const Trial& trial, bool crosses, Random& random) {
  const double edge = bench.model.mechanism.length / 24;
  Vector3 p = bench.home().p + trial.centre + random.vector(0.8 * trial.reach);
  Vector3 way = random.vector(0.07 * edge);
  if (crosses) {
    p = edge * ((p / edge).array().floor() + 0.5);
    p.x() += edge / 2 - way.x() / 2;
  }
  const auto load = [&](double share) { return random.six(share * trial.force, share * trial.moment); };
  const Vector6 F = load(1);
  return {{p, F}, {p + way, F + load(0.1)}, load(0.02)};
}

/// Places between the ends, where the load is even but for a kink in the middle.
std::vector<BatchRequest> inside(const LoadedLine& line, int count) {
  std::vector<BatchRequest> places;
  for (int k = 1; k < count; ++k) {
    const double u = static_cast<double>(k) / count, kink = 1 - std::abs(2 * u - 1);
    places.push_back({(1 - u) * line.begin.at.p + u * line.end.at.p,
                      (1 - u) * line.begin.F + u * line.end.F + kink * line.kink});
  }
  return places;
}

double off_chord(const Vector3& a, const Vector3& b, double u, const Vector3& p) {
  return (p - (1 - u) * a - u * b).norm();
}

}  // namespace

TEST_CASE(
    "batches: between the ends of a short line, commands and tips are as near to their chords as is "
    "promised") {
  int bounded = 0, asked = 0;
  double sharpest = 0;
  for (const BatchTrial& batch_trial : batch_trials()) {
    CAPTURE(batch_trial.trial.name);
    CAPTURE(batch_trial.at_platform);
    BatchBench bench(batch_trial.machine, batch_trial.at_platform);
    Random random(31);
    for (int i = 0; i < 12; ++i, ++asked) {
      const LoadedLine line = some_line(bench, batch_trial.trial, i % 2 == 0, random);
      const LineBend bend = bench.solver.bend_along(
          {line.begin.at.p, line.end.at.p, line.begin.F, line.end.F, {&line.kink, 1}});
      if (!std::isfinite(bend.command)) continue;
      ++bounded;
      std::vector<BatchRequest> places = inside(line, 16);
      places.insert(places.begin(), line.begin);
      places.push_back(line.end);
      for (const BatchQuestion question : {BatchQuestion::target, BatchQuestion::forward}) {
        const bool target = question == BatchQuestion::target;
        const auto answers = bench.solve(question, whole, places);
        const auto place = [&](const BatchAnswer& answer) {
          return (target ? answer.command : answer.X_MT).p;
        };
        const double bound = target ? bend.command : bend.gain * bend.command;
        for (std::size_t k = 1; k + 1 < answers.size(); ++k) {
          REQUIRE(answers[k].solved);
          const double u = static_cast<double>(k) / 16;
          const double off = off_chord(place(answers.front()), place(answers.back()), u, place(answers[k]));
          CAPTURE(bound);
          CHECK(off <= bound + 1e-10);
          sharpest = std::max(sharpest, off / bound);
        }
      }
    }
  }
  CHECK(bounded > 0.9 * asked);
  CHECK(sharpest > 0.1);  // else nearly all lines would be solved inside
}

TEST_CASE("batches: a short line of a cut needs no solution inside") {
  BatchBench bench(machine_of("orthoglide_case_b"));
  Vector6 F;
  F << 215, -10, -25, 1, 21.5, 0;
  const Vector3 p = bench.home().p;
  const LineBend bend = bench.solver.bend_along({p, p + Vector3(1e-3, 0, 0), F, F, {}});
  CHECK(bend.command < 1e-6);
  CHECK(bench.solver.bend_along({p, p + Vector3(0.2e-3, 0, 0), F, F, {}}).command < 0.05e-6);
  CHECK(bend.gain > 1);
  CHECK(bend.gain < 1.2);
}

TEST_CASE("batches: nothing is promised of a line that goes beyond the neighbouring cell, or has none") {
  BatchBench bench(machine_of("orthoglide_case_b"));
  const Vector3 p = bench.home().p, far(0.9, 0, 0);
  const auto bend = [&](const Vector3& a, const Vector3& b) {
    return bench.solver.bend_along({a, b, Vector6::Zero(), Vector6::Zero(), {}}).command;
  };
  CHECK(std::isfinite(bend(p, p)));
  CHECK(std::isinf(bend(p, p + Vector3(0.1, 0, 0))));
  CHECK(std::isinf(bend(far, far)));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(std::isinf(bend(Vector3(nan, 0, 0), p)));
}

TEST_CASE("batches: nothing is promised of a cell whose remainder is not known") {
  kernel::OffsetBounds bounds;
  bounds.half_edge = 1e-3, bounds.load = 250;
  CHECK(chord_bounds(bounds, {.way = 1e-4}).command == 0);
  bounds.remainder.fill(std::numeric_limits<double>::infinity());
  CHECK(std::isinf(chord_bounds(bounds, {.way = 1e-4}).command));
}
