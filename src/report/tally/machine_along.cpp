#include "counterflex/report/machine_along.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/files/parallel.hpp"
#include "counterflex/machine/program_axes.hpp"

namespace counterflex {
namespace {

std::vector<ConstantAxis> constant_axes(const Machine& machine) {
  std::vector<ConstantAxis> axes;
  for (const Actuator& axis : program_axes(machine))
    axes.push_back({fmt::format("E{}", axis.program_axis), axis.joint.kind, axis.home});
  return axes;
}

}  // namespace

MachineAlong machine_along(const Machine& machine, const Model& model, const std::vector<LoadPlace>& places,
                           int threads, const StartTables* starts) {
  MachineAlong along{.axes = model.mechanism.travel,
                     .constant = constant_axes(machine),
                     .places = {},
                     .least_arm_margin = {}};
  const bool turns_tool =
      std::any_of(places.begin(), places.end(), [](const LoadPlace& place) { return bool(place.at.R_MT); });
  if (turns_tool) along.least_arm_margin = least_arm_margin;
  const std::vector<NominalResult> nominal = solve_nominal(places, threads, starts);
  along.places.resize(places.size());
  for_each_index(places.size(), threads, [&](std::size_t i) {
    MachinePlace& at = along.places[i];
    at.s = places[i].at.s;
    at.line = places[i].at.line;
    at.place.status = nominal[i].status;
    if (at.place.status != Status::converged) return;
    at.conditioning = 1 / actuator_jacobian(*places[i].model, nominal[i].configuration).condition;
    at.lines = skeleton(places[i].model->mechanism, nominal[i].configuration);
  });
  Eigen::VectorXd rho = actuator_values(model.mechanism, model.home);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (nominal[i].status != Status::converged) continue;
    along.places[i].place = place_of(*places[i].model, nominal[i].configuration, rho);
    rho = joint_values(places[i].model->mechanism.shown, along.places[i].place.shown);
  }
  return along;
}

}  // namespace counterflex
