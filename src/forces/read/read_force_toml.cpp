#include <fmt/format.h>

#include "counterflex/forces/cutting_model.hpp"
#include "counterflex/forces/forces.hpp"

namespace counterflex {

std::vector<ForceRule> read_force_toml(std::string_view text, const std::string& file) {
  std::vector<ForceRule> rules;
  for (const CutSection& section : read_cutting_model(text, file)) {
    const std::string counted = fmt::format("section {}", rules.size() + 1);
    const std::string name = section.name == counted ? counted : fmt::format("section \"{}\"", section.name);
    rules.push_back({name, section.where, section.selector, respond(section.model)});
  }
  return rules;
}

}  // namespace counterflex
