#include <fmt/format.h>

#include "counterflex/files/csv_text.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/forces/forces.hpp"
#include "forces/read/selector_text.hpp"

namespace counterflex {

Vector6 parse_force(std::string_view text) {
  const auto fields = csv::split(text);
  if (fields.size() != 3 && fields.size() != 6) {
    throw InputError(
        ErrorKind::usage, {},
        fmt::format("force '{}' has {} numbers, must be FX,FY,FZ or FX,FY,FZ,MX,MY,MZ in N and N m", text,
                    fields.size()));
  }
  Vector6 F = Vector6::Zero();
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto value = read_number(fields[i].text);
    if (!value) {
      throw InputError(ErrorKind::usage, {},
                       fmt::format("force '{}': '{}' must be a finite number in {}", text, fields[i].text,
                                   i < 3 ? "N" : "N m"));
    }
    F[static_cast<Eigen::Index>(i)] = *value;
  }
  return F;
}

ForceRule parse_force_rule(std::string_view text) {
  const std::string name = "--force " + std::string(text);
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return {name, {}, {}, ConstantForce{parse_force(text)}};
  ForceSelector selector;
  selector.tool = read_tool(csv::trimmed(text.substr(0, equals)));
  if (!selector.tool)
    throw InputError(
        ErrorKind::usage, {},
        fmt::format("force '{}': '{}' must be a tool, as in T3=FX,FY,FZ", text, text.substr(0, equals)));
  return {name, {}, selector, ConstantForce{parse_force(text.substr(equals + 1))}};
}

}  // namespace counterflex
