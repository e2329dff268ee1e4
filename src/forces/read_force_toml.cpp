#include "counterflex/forces/forces.hpp"
#include "counterflex/forces/read_cutting_model.hpp"

namespace counterflex {

std::vector<ForceRule> read_force_toml(std::string_view text, const std::string& file) {
  std::vector<ForceRule> rules;
  for (const CutSection& section : read_cutting_model(text, file))
    rules.push_back({section.name, section.where, section.selector, respond(section.model)});
  return rules;
}

}  // namespace counterflex
