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

inline const char* name_of(Method method) {
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

}  // namespace counterflex
