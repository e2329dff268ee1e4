#pragma once
/// What a file, the environment or a flag says about one option of the command line.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/files/input_error.hpp"

namespace counterflex {

enum class Origin { flag, environment, file, builtin };

/// Values as the command line takes them, so that one piece of code judges them all. A switch has "true" or
/// "false". Without values the option is as if it had never been given: `report = false` hides what the
/// project file says of reports.
struct Setting {
  std::string option;               ///< its long name without dashes: "tolerance-mm"
  std::vector<std::string> values;  ///< paths of files are joined with the folder of the file that says them
  Location where;  ///< in a file: of the value; of the environment: the variable as a file without lines
  Origin origin = Origin::file;
  std::vector<Location> places{};  ///< in a file: of each value
};

/// Where value `i` stands.
const Location& place_of(const Setting& setting, std::size_t i);

/// What a person who wrote the setting calls it: "--tolerance-mm", "COUNTERFLEX_TOLERANCE_MM",
/// "tolerance_mm".
std::string shown_option(std::string_view option, Origin origin);

}  // namespace counterflex
