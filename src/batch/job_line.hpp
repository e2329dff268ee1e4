#pragma once
/// The line of a job in a manifest, and what is wrong with one.
#include <cstddef>
#include <string>
#include <string_view>
#include <variant>

#include "counterflex/batch/job_outcome.hpp"

namespace counterflex {

struct LineTrouble {
  std::size_t column;  ///< from 1, in bytes
  std::string what;
};

/// Takes only what `to_json_line` writes, byte for byte: whatever is read would be written as it was found.
std::variant<JobOutcome, LineTrouble> read_job_line(std::string_view line);

/// Any bytes as UTF-8: a byte that is none is written as % and two hexadecimal digits, % itself as %25.
std::string utf8_of_bytes(std::string_view bytes);

/// The bytes that `utf8_of_bytes` was given, for what it writes.
std::string bytes_of_utf8(std::string_view text);

}  // namespace counterflex
