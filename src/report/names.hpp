#pragma once
/// Names of enumerations in reports and on the command line.
#include <string_view>

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

}  // namespace counterflex
