#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "forces/sample_path.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// Three passes along a wavy face in blocks of about 0.1 mm, as finishing programs have them, a rapid between
/// two.
Program wavy_face() {
  ProgramBuilder builder({0, 0, 9});
  for (int pass = 0; pass < 3; ++pass) {
    builder.rapid({0, 0.3 * pass, 5}).feed({0, 0.3 * pass, 0}, 200);
    for (int i = 1; i <= 250; ++i) builder.feed({0.1 * i, 0.3 * pass, 0.8 * std::sin(0.09 * i + pass)}, 1200);
    builder.rapid({25, 0.3 * pass, 5});
  }
  return builder.program;
}

/// A wrench for every line of `program`, by line; equal ones follow each other here and there.
ForceSource one_a_block(const Program& program, double blend) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> force(-300, 300);
  std::string text = on_tool + "line,fx_N,fy_N,fz_N,mz_Nm\n";
  for (std::size_t line = 1; line <= program.moves.size(); ++line)
    if (line % 5 != 0 || line == 1)
      text += fmt::format("{},{:.3f},{:.3f},{:.3f},{:.3f}\n", line, force(random), force(random),
                          force(random), force(random) / 50);
  return from_csv(text, blend);
}

/// The blocks of a feed run: path length where each ends, and its own wrench.
struct Run {
  std::vector<std::size_t> segments;
  std::vector<double> ends;
  std::vector<Vector6> own;
  double start = 0;

  /// 1/b int_(s-b)^s f du, block by block.
  Vector6 mean(double s, double b) const {
    Vector6 sum = Vector6::Zero();
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const double from = std::max(i == 0 ? start : ends[i - 1], s - b), to = std::min(ends[i], s);
      if (to > from) sum += (to - from) / b * own[i];
    }
    return sum;
  }
};

std::vector<Run> runs_of(const Program& program, const ForceSource& source) {
  const Toolpath path = build_toolpath(program, one_frame(program, {}));
  ForceSource sharp = source;
  sharp.blend = 0;
  const auto own = forces_on(program, sharp);
  std::vector<Run> runs;
  for (std::size_t i = 0; i < path.segments.size(); ++i) {
    if (!path.segments[i].cutting) continue;
    if (i == 0 || !path.segments[i - 1].cutting) runs.push_back({{}, {}, {}, path.segments[i].s_start});
    runs.back().segments.push_back(i);
    runs.back().ends.push_back(path.segments[i].s_end);
    runs.back().own.push_back(own.at(i, 0.5));
  }
  return runs;
}

double blend_of(const Run& run, double blend) {
  return std::min(blend, (run.ends.back() - run.start) / 2);
}

}  // namespace

TEST_CASE("in blocks of 0.1 mm with a wrench each the force is the moving mean, computed block by block") {
  const Program program = wavy_face();
  for (const double blend : {0.05e-3, 0.73e-3, 2e-3, 40e-3}) {
    CAPTURE(blend);
    const ForceSource source = one_a_block(program, blend);
    const auto forces = forces_on(program, source);
    for (const Run& run : runs_of(program, source))
      for (std::size_t k = 0; k < run.ends.size(); k += 3) {
        const double s0 = k == 0 ? run.start : run.ends[k - 1], s1 = run.ends[k];
        for (const double u : {0.0, 0.37, 1.0}) {
          const Vector6 expected = run.mean(s0 + u * (s1 - s0), blend_of(run, blend));
          CHECK(near(forces.at(run.segments[k], u), expected, 1e-6));
        }
      }
  }
}

TEST_CASE("the moving mean is continuous over blocks of 0.1 mm, and never steeper than a ramp of the blend") {
  const Program program = wavy_face();
  const double blend = 2e-3;
  const ForceSource source = one_a_block(program, blend);
  const auto forces = forces_on(program, source);
  for (const Run& run : runs_of(program, source)) {
    double largest = 0;
    for (const Vector6& F : run.own) largest = std::max(largest, 2 * F.norm());
    CHECK(forces.at(run.segments.front(), 0).norm() < 1e-9);
    for (std::size_t k = 0; k < run.segments.size(); ++k) {
      const std::size_t i = run.segments[k];
      const double way = run.ends[k] - (k == 0 ? run.start : run.ends[k - 1]);
      if (k > 0) CHECK(near(forces.at(i - 1, 1), forces.at(i, 0), 1e-6));
      CHECK((forces.at(i, 1) - forces.at(i, 0)).norm() <= largest * way / blend_of(run, blend) + 1e-6);
    }
  }
}

TEST_CASE("every change between blocks is counted once: as a ramp, or as a jump without a blend") {
  const Program program = wavy_face();
  const ForceSource blended = one_a_block(program, 2e-3), sharp = one_a_block(program, 0);
  std::size_t changes = 0;
  double largest = 0;
  for (const Run& run : runs_of(program, blended))
    for (std::size_t k = 0; k < run.own.size(); ++k) {
      const Vector6 before = k == 0 ? wrench(0, 0, 0) : run.own[k - 1];
      changes += before != run.own[k];
      largest = std::max(largest, (run.own[k] - before).head<3>().norm());
    }
  const auto ramps = forces_on(program, blended), jumps = forces_on(program, sharp);
  CHECK(ramps.ramps() == changes);
  CHECK(ramps.jumps() == 0);
  CHECK(jumps.jumps() == changes);
  CHECK(jumps.ramps() == 0);
  CHECK(ramps.largest_step_N() == doctest::Approx(largest));
  CHECK(jumps.largest_step_N() == doctest::Approx(largest));
}

TEST_CASE("of 0.1 mm blocks those wholly above the air's height carry nothing, and the mean fades over it") {
  const Program program = wavy_face();
  ForceSource source = one_a_block(program, 0);
  source.air_above_mm = 0.3;
  const auto sharp = forces_on(program, source);
  const auto touches = [&](std::size_t i) {
    return std::min(program.moves[i].start_mm.z(), program.moves[i].end_mm.z()) <= 0.3;
  };
  const auto given = forces_on(program, one_a_block(program, 0));
  std::size_t in_the_air = 0;
  for (std::size_t i = 0; i < program.moves.size(); ++i) {
    if (program.moves[i].motion == Motion::rapid) continue;
    in_the_air += !touches(i);
    CHECK(near(sharp.at(i, 0.5), touches(i) ? given.at(i, 0.5) : wrench(0, 0, 0)));
  }
  CHECK(in_the_air > 100);
  CHECK(sharp.unforced().size() == in_the_air);
  source.blend = 2e-3;
  const auto blended = forces_on(program, source);
  for (const Run& run : runs_of(program, source))
    for (std::size_t k = 0; k < run.ends.size(); k += 7)
      CHECK(near(blended.at(run.segments[k], 1), run.mean(run.ends[k], blend_of(run, 2e-3)), 1e-6));
}
