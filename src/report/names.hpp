#pragma once
/// Words for enumerations, as reports and the command line have them.
#include "counterflex/report/report.hpp"

namespace counterflex {

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
