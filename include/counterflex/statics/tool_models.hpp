#pragma once
/// Models of a machine with the tools that a program uses, for those tools that make it another machine.
#include <map>
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

}  // namespace counterflex
