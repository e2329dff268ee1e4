#include "counterflex/machine/machine.hpp"
#include "counterflex/statics/nominal.hpp"
#include "statics/model/home.hpp"

namespace counterflex {
namespace {

// A chain that is longer than before: its new coordinates are zero.
SeriesState extended(const Series& series, SeriesState shorter) {
  const Eigen::VectorXd x = shorter.x;
  shorter.x.setZero(series.columns);
  shorter.x.head(x.size()) = x;
  return shorter;
}

// Chains that have become the branches of one chain's group.
SeriesState grouped(const Series& series, const Configuration& home) {
  SeriesState state;
  state.x.setZero(series.columns);
  state.groups = {{home.X_MP, home.chains}};
  return state;
}

// The joints of `home`, with an elastic tool behind them, whose tip is at `X_PT`.
Configuration with_tool_at_home(const Series& chain, const Configuration& home, const Pose& X_PT) {
  const bool one = home.chains.size() == 1;
  return {home.X_MP * X_PT, {one ? extended(chain, home.chains.front()) : grouped(chain, home)}};
}

}  // namespace

Model prepare_with_tool(const Machine& machine, const Model& base, const Tool& tool) {
  const Machine bent = with_tool(machine, tool);
  Model model;
  model.mechanism = compile(bent);
  model.home = base.home;
  model.home_status = base.home_status;
  model.home_gap = base.home_gap;
  if (!tool.yields.empty())
    model.home = with_tool_at_home(model.mechanism.chains.front(), base.home, tip_of(machine, tool));
  settle_at_home(model);
  set_zero_offsets(zero_offsets(base.mechanism), model.mechanism);  // one zero for all tools
  model.gravity_status = base.gravity_status;
  return model;
}

ToolModels prepare_tools(const Machine& machine, const Model& base, const std::vector<long>& numbers) {
  ToolModels models;
  for (const long number : numbers) {
    const auto found = machine.tools.find(number);
    if (number != 0 && found != machine.tools.end() && changes_model(machine, found->second))
      models.emplace(number, prepare_with_tool(machine, base, found->second));
  }
  return models;
}

void NominalToolPath::begin(const Model& model) {
  model_ = &model;
  R_home_ = tip(model.mechanism, model.home).R;
  path_.emplace(model, model.home);
}

Status NominalToolPath::go_to(const Model& model, const Vector3& p_MT, const std::optional<Matrix3>& R_MT) {
  if (&model != model_) begin(model);
  return path_->go_to({R_MT.value_or(R_home_), p_MT});
}

Matrix3 NominalToolPath::orientation() const {
  return tip(model_->mechanism, configuration()).R;
}

}  // namespace counterflex
