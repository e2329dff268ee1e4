#include "counterflex/compensation/outermost_commands.hpp"

#include "compensation/solve/commands.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/toolpath/reach.hpp"

namespace counterflex {

std::vector<TipPosition> outermost_commands(const Job& job, const Waypoint& w, double u_before) {
  std::vector<TipPosition> commands;
  const Move& move = job.program.moves[w.move];
  const Model& model = model_of(job, w.move);
  const auto add = [&](const Vector3& original) {
    commands.push_back({&model, original + w.correction.head<3>(), commanded_orientation(w)});
  };
  if (w.segment != no_segment && move.arc && !w.R_MT) {
    const Curve& wanted = job.path.segments[w.segment].wanted;
    for (const double u : outermost_fractions(wanted))
      if (u > u_before && u < w.fraction) add(original_command(job, move.frame, point_at(wanted, u)));
  }
  if (!w.cutting && w.fraction == 1)
    for (const Vector3& p_mm : places_of_cycle(move)) add(position_of_words(job, move, p_mm));
  return commands;
}

std::optional<Eigen::VectorXd> actuators_at(const TipPosition& command) {
  const Model& model = *command.model;
  const Pose X_MT{command.R_MT.value_or(tip(model.mechanism, model.home).R), command.p_MT};
  const NominalResult there = follow(model, model.home, X_MT);
  if (there.status != Status::converged) return std::nullopt;
  return actuator_values(model.mechanism, there.configuration);
}

}  // namespace counterflex
