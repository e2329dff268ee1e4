#pragma once
/// A shop floor in memory: a machine, a program and forces, from which tests make jobs.
#include <doctest/doctest.h>

#include <memory>
#include <string>

#include "compensation/solve/branch.hpp"
#include "compensation/support/one_window.hpp"
#include "counterflex/compensation/windows.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/program/overview.hpp"
#include "counterflex/statics/equilibrium.hpp"

namespace counterflex::test {

inline const std::string orthoglide_b = COUNTERFLEX_SOURCE_DIR "/tests/statics/data/orthoglide_case_b.toml";
inline const std::string orthoglide_a = COUNTERFLEX_SOURCE_DIR "/tests/statics/data/orthoglide_case_a.toml";
inline const std::string orthoglide_perfect =
    COUNTERFLEX_SOURCE_DIR "/tests/statics/data/orthoglide_perfect.toml";
inline const std::string hexapod = COUNTERFLEX_SOURCE_DIR "/tests/statics/data/hexapod_free_joints.toml";
inline const std::string robot = COUNTERFLEX_SOURCE_DIR "/tests/statics/data/serial6r_joints.toml";
inline const std::string strut = COUNTERFLEX_SOURCE_DIR "/tests/statics/data/bar_buckling.toml";
inline const std::string mill = COUNTERFLEX_SOURCE_DIR "/samples/mill3/machine.toml";
/// One axis not square, and a head that deflects 20 µm under 100 N.
inline const std::string small_mill = COUNTERFLEX_SOURCE_DIR "/tests/cli/data/mill.toml";
inline const std::string groove = COUNTERFLEX_SOURCE_DIR "/samples/orthoglide-groove/groove.ngc";

/// The paper's milling wrench (N, N m).
inline Vector6 milling() {
  return (Vector6() << 215, -10, -25, 1, 21.5, 0).finished();
}

inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

/// What a test requests; everything else is a run's default. Lengths in m.
struct Order {
  Machine machine;
  std::string text;
  ForceSource force{};
  Method method = Method::direct;
  double tolerance = 5e-6;
  double max_correction = 5e-3;
  int decimals = -1;
  int threads = 1;
  Pose X_MW{};
  Vector3 datum_shift = Vector3::Zero();
  std::array<bool, 3> ignored{};  ///< program axes that the machine does not control
  ReadOptions read{};
  bool in_batches = true;  ///< else every waypoint is solved by itself
};

/// Keeps alive what a job borrows.
struct Shop {
  explicit Shop(const Order& order)
      : model(prepare(order.machine)),
        program(read_program(order.text, "part.ngc", order.read)),
        X_MW(order.X_MW),
        read(order.read) {
    REQUIRE(model.home_status == Status::converged);
    tools = prepare_tools(order.machine, model, overview_of(program).tools);
    ignore_axes(program, order.ignored);
    std::vector<WorkFrame> frames = one_frame(program, {{}, X_MW, order.datum_shift});
    for (std::size_t i = 0; i < frames.size(); ++i)
      if (const auto& X = program.frames[i].pose_mm) frames[i].X_MW = {X->R, X->p * mm};
    path = build_toolpath(program, frames);
    forces.emplace(order.force, program, path, std::vector<Matrix3>{tip(model.mechanism, model.home).R});
    options.method = order.method;
    options.tolerance = order.tolerance;
    options.max_correction = order.max_correction;
    options.blend = order.force.blend;
    options.threads = order.threads;
    options.write.decimals = order.decimals;
    datum_shift = order.datum_shift;
    if (order.in_batches) starts.emplace();
    DirectionsEnd unknown, known;
    add_first_motions(directions_along(job(), unknown), known.directions);
    directions = directions_along(job(), known);
  }

  Job job() const {
    return {model,   program,
            path,    *forces,
            options, read,
            &tools,  starts ? &*starts : nullptr,
            {},      has_reversals(model) ? &directions : nullptr};
  }
  Compensation run(bool attribution = false) const { return compensate(job(), attribution); }

  Model model;
  ToolModels tools;
  Program program;
  Toolpath path;
  Pose X_MW;
  ReadOptions read;
  std::optional<PathForces> forces;
  CompensationOptions options;
  Vector3 datum_shift;
  std::optional<StartTables> starts;
  PathDirections directions;
};

inline ForceSource constant_force(const Vector6& F, double blend = 2e-3) {
  ForceSource source;
  source.rules = {{"--force", {}, {}, ConstantForce{F}}};
  source.blend = blend;
  return source;
}

inline ForceSource profile_of(const std::string& header, const std::string& rows, double blend) {
  ForceSource source;
  source.rules = read_force_csv(
      "# frame = machine\n# sense = on_tool\n" + header + "s_mm, fx_N, fy_N, fz_N\n" + rows, "forces.csv");
  source.blend = blend;
  return source;
}

inline ForceSource step_profile(const std::string& rows, double blend) {
  return profile_of("", rows, blend);
}

/// The force changes evenly between rows.
inline ForceSource linear_profile(const std::string& rows, double blend) {
  return profile_of("# interpolation = linear\n", rows, blend);
}

/// The run's result, which must be without failure.
inline Compensation compensated(const Shop& shop, bool attribution = false) {
  Compensation result = shop.run(attribution);
  if (result.failure) {
    CAPTURE(result.failure->line);
    FAIL_CHECK(result.failure->what);
  }
  REQUIRE(!result.failure);
  return result;
}

struct LargestCorrection {
  double size = 0;  ///< m
  int line = 0;
};

/// The largest written target minus the original one, at the ends of moves; the first of equal ones.
inline LargestCorrection largest_correction(const std::vector<Waypoint>& waypoints) {
  LargestCorrection largest;
  for (const Waypoint& w : waypoints) {
    const double size = w.correction.head<3>().norm();
    if (!w.between && size > largest.size) largest = {size, w.line};
  }
  return largest;
}

}  // namespace counterflex::test
