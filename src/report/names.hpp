#pragma once
/// Names of enumerations, and units of joints, in reports and on the command line.
#include <string_view>

#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/machine.hpp"
#include "counterflex/report/report.hpp"

namespace counterflex {

/// Of the documents of runs.
inline constexpr std::string_view report_schema = "counterflex-report 1";

inline const char* name_of(Command command) {
  switch (command) {
    case Command::compensate:
      return "compensate";
    case Command::predict:
      return "predict";
    case Command::verify:
      return "verify";
  }
  return "";
}

/// In which the values of a joint are shown.
struct JointUnit {
  const char* name;
  double si;
};
inline JointUnit unit_of(JointKind kind) {
  return kind == JointKind::prismatic ? JointUnit{"mm", mm} : JointUnit{"deg", deg};
}

}  // namespace counterflex
