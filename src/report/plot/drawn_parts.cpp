#include "report/plot/drawn_parts.hpp"

#include <fmt/format.h>

#include <variant>

namespace counterflex {
namespace {

Pose moved_by(const Joint& joint, double value) {
  return joint.kind == JointKind::prismatic ? translation(joint.axis * value)
                                            : rotation(exp_so3(joint.axis * value));
}

/// Walks the elements of a chain with the coordinates of its state. Springs and errors are zero at home.
class Walk {
 public:
  Walk(const Machine& machine, std::vector<DrawnPart>& parts)
      : names_(actuator_names(machine)), parts_(parts) {}

  void add(const std::vector<Element>& elements, const SeriesState& state, Pose X) {
    Eigen::Index column = 0;
    std::size_t group = 0;
    int compliances = 0, masses = 0;
    for (const Element& element : elements) {
      if (const auto* rigid = std::get_if<Rigid>(&element)) X = X * rigid->X;
      if (const auto* actuator = std::get_if<Actuator>(&element)) {
        add_actuator(*actuator, X);
        X = X * moved_by(actuator->joint, actuator->program_axis > 0 ? actuator->home : state.x[column++]);
      }
      if (const auto* passive = std::get_if<Passive>(&element))
        X = X * moved_by(passive->joint, state.x[column++]);
      if (const auto* compliance = std::get_if<Compliance>(&element)) {
        ++column;
        ++compliances;
        parts_.push_back(
            {DrawnKind::spring,
             compliance->name.empty() ? fmt::format("compliance{}", compliances) : compliance->name, X.p});
      }
      if (const auto* spring = std::get_if<Spring>(&element)) {
        column += 6;
        parts_.push_back({DrawnKind::spring, spring->name, X.p});
      }
      if (const auto* mass = std::get_if<PointMass>(&element)) {
        ++masses;
        parts_.push_back(
            {DrawnKind::mass,
             fmt::format("{} {:.3g} kg", mass->name.empty() ? fmt::format("mass{}", masses) : mass->name,
                         mass->kg),
             X * mass->at});
      }
      if (const auto* parallel = std::get_if<Group>(&element)) {
        const GroupState& inner = state.groups[group++];
        for (std::size_t b = 0; b < parallel->branches.size(); ++b)
          add(parallel->branches[b].elements, inner.branches[b], X);
        X = X * inner.X;
        column += 6;
      }
    }
  }

 private:
  void add_actuator(const Actuator& actuator, const Pose& X) {
    std::string name =
        actuator.program_axis > 0 ? fmt::format("E{}", actuator.program_axis) : names_[next_++];
    if (name.starts_with("axis ") || name.starts_with("chain ")) name.erase(0, name.find(' ') + 1);
    parts_.push_back(
        {actuator.joint.kind == JointKind::prismatic ? DrawnKind::linear_axis : DrawnKind::rotary_axis,
         std::move(name), X.p});
  }

  std::vector<std::string> names_;
  std::size_t next_ = 0;
  std::vector<DrawnPart>& parts_;
};

}  // namespace

std::vector<DrawnPart> drawn_parts(const Machine& machine, const Model& model) {
  std::vector<DrawnPart> parts;
  Walk walk(machine, parts);
  for (std::size_t i = 0; i < machine.chains.size(); ++i)
    walk.add(machine.chains[i].elements, model.home.chains[i], Pose{});
  for (const auto& [name, work] : machine.work) parts.push_back({DrawnKind::work, name, work.X_MW.p});
  parts.push_back({DrawnKind::tip, "tip", tip(model.mechanism, model.home).p});
  return parts;
}

}  // namespace counterflex
