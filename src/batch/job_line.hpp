#pragma once
/// The line of a job in a manifest, and its errors.
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

/// Accepts only lines as `to_json_line` writes them, byte for byte: writing a line that was read reproduces
/// it.
std::variant<JobOutcome, LineTrouble> read_job_line(std::string_view line, ExitStatusOf exit_status);

/// The exit status of a job; 0 without an error.
inline int exit_number(const std::optional<ErrorKind>& error, ExitStatusOf exit_status) {
  return error ? exit_status(*error) : 0;
}

}  // namespace counterflex
