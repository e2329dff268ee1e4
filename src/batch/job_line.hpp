#pragma once
/// The line of a job in a manifest, and what is wrong with one.
#include <cstddef>
#include <string>
#include <string_view>
#include <variant>

#include "counterflex/batch/manifest.hpp"
#include "counterflex/files/text.hpp"

namespace counterflex {

struct LineTrouble {
  std::size_t column;  ///< from 1, in bytes
  std::string what;
};

/// Takes only what `to_json_line` writes, byte for byte: whatever is read would be written as it was found.
std::variant<JobOutcome, LineTrouble> read_job_line(std::string_view line);

}  // namespace counterflex
