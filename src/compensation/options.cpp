#include "counterflex/compensation/options.hpp"

namespace counterflex {

std::string_view to_string(Method method) {
  switch (method) {
    case Method::direct:
      return "direct";
    case Method::nested:
      return "nested";
    case Method::linear:
      return "linear";
  }
  return "";
}

const Model& model_with(const Model& model, const ToolModels* tools, long tool) {
  if (tools == nullptr) return model;
  const auto found = tools->find(tool);
  return found == tools->end() ? model : found->second;
}

}  // namespace counterflex
