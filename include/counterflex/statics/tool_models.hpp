#pragma once
/// Models of a machine with the tools that a program uses, for those tools that make it another machine.
#include <map>
#include <optional>
#include <vector>

#include "counterflex/statics/nominal.hpp"

namespace counterflex {

/// By tool number. A tool that is not in it leaves the machine as it is with [tool].
using ToolModels = std::map<long, Model>;

/// The model of `machine` with `tool` in its spindle; its home is that of `base`, the model of `machine`: the same joints,
/// on the same branch.
Model prepare_with_tool(const Machine& machine, const Model& base, const Tool& tool);

/// Of those of `numbers` that are in [tools] and change the model. Number 0 stands for no known tool, and has none.
ToolModels prepare_tools(const Machine& machine, const Model& base, const std::vector<long>& numbers);

/// A nominal configuration, and the model that it is one of.
struct NominalPlace {
  const Model* model = nullptr;
  Configuration configuration{};
};

/// Where inverse kinematics of `model` starts.
NominalPlace home_of(const Model& model);

/// The nominal path of a machine whose tools change: it begins anew at home where the model does, and its tip is asked for
/// the orientation that it has at that home.
class NominalToolPath {
 public:
  explicit NominalToolPath(const NominalPlace& start);

  /// Moves the tip of `model` to `p_MT` (m, in M); `model` outlives the path. As `NominalPath::go_to`.
  Status go_to(const Model& model, const Vector3& p_MT);

  const Configuration& configuration() const { return path_->configuration(); }
  NominalPlace place() const { return {model_, configuration()}; }

  /// Orientation of the tip where the machine stands, in M.
  Matrix3 orientation() const;

 private:
  void begin(const Model& model, const Configuration& start);

  const Model* model_ = nullptr;
  Matrix3 R_home_ = Matrix3::Identity();
  std::optional<NominalPath> path_;
};

}  // namespace counterflex
