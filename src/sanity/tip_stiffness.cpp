#include "counterflex/statics/tip_stiffness.hpp"

#include <fmt/format.h>

#include <cmath>

#include "counterflex/geometry/types.hpp"
#include "counterflex/sanity/checks.hpp"

namespace counterflex {
namespace {

// Machining robots have 0.2 to 2 N/um at the tip, mills 10 to 200.
constexpr double softest_N_per_um = 0.05, stiffest_N_per_um = 1000;

std::string stiffness_text(double N_per_um) {
  return std::isinf(N_per_um) ? "rigid" : fmt::format("{:.3g}", N_per_um);
}

}  // namespace

std::optional<Vector3> tip_stiffness(const Model& model, const std::optional<Vector3>& p_MT) {
  Configuration nominal = model.home;
  if (p_MT) {
    const NominalResult there = follow(model, model.home, {tip(model.mechanism, model.home).R, *p_MT});
    if (there.status != Status::converged) return std::nullopt;
    nominal = there.configuration;
  }
  StaticsWork work(model.mechanism);
  const Equilibrium unloaded = solve_forward(model, nominal, Load{}, Stage{}, work);
  if (unloaded.status != Status::converged) return std::nullopt;
  const auto C = compliance_at_tip(model, unloaded.configuration, Load{}, Stage{}, work);
  if (!C) return std::nullopt;
  Vector3 stiffness;
  for (int axis = 0; axis < 3; ++axis) stiffness[axis] = stiffness_along(*C, Vector3::Unit(axis));
  return stiffness;
}

SanityCheck check_tip_stiffness(const std::optional<Vector3>& stiffness, const std::string& where) {
  if (!stiffness)
    return {"tip stiffness", SanityState::unknown,
            fmt::format("{} the machine has no equilibrium in the orientation of home", where)};
  const Vector3 k = *stiffness / N_per_um;
  if (!k.array().isFinite().any())
    return {"tip stiffness", SanityState::ok, fmt::format("rigid along x, y and z {}", where)};
  const std::string text = fmt::format("{}, {}, {} N/um along x, y, z {}", stiffness_text(k.x()),
                                       stiffness_text(k.y()), stiffness_text(k.z()), where);
  if (k.minCoeff() < softest_N_per_um)
    return {"tip stiffness", SanityState::doubtful,
            text +
                "; a machining robot has 0.2 to 2, a mill 10 to 200: are stiffnesses in N/mm where the file "
                "has N/m?"};
  for (int axis = 0; axis < 3; ++axis)
    if (std::isfinite(k[axis]) && k[axis] > stiffest_N_per_um)
      return {"tip stiffness", SanityState::doubtful,
              text + "; a mill has 10 to 200: are stiffnesses in a smaller unit than the keys name?"};
  return {"tip stiffness", SanityState::ok, text};
}

}  // namespace counterflex
