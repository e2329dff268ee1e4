#pragma once
/// Outcomes of made-up jobs.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <random>
#include <string>

#include "counterflex/batch/manifest.hpp"
#include "counterflex/files/files.hpp"

namespace counterflex::test {

/// Exit statuses of a made-up program.
inline int status_of(ErrorKind kind) {
  return 10 * (1 + static_cast<int>(kind));
}

inline JobOutcome made_up_outcome(int number) {
  JobOutcome outcome;
  outcome.key = sha256(fmt::format("key {}", number));
  outcome.program = fmt::format("parts/O{}.ngc", 1000 + number);
  outcome.output = fmt::format("corrected/O{}.ngc", 1000 + number);
  outcome.inputs = {{outcome.program, sha256("program")}, {"machine.toml", sha256("machine")}};
  outcome.outputs = {{outcome.output, sha256("corrected")}};
  outcome.verdict = number % 2 == 0 ? "OK" : "PARTLY";
  outcome.verdict_reason = number % 2 == 0 ? "" : "54 % of the cutting length, worst 0.0095 mm > 0.005";
  outcome.before_mm = 0.1 * number;
  outcome.after_mm = 1e-17 / (1 + number);
  outcome.corrected_percent = 100.0 / 3;
  outcome.warnings = 7;
  outcome.moves = 123456789012;
  return outcome;
}

inline JobOutcome failed_outcome(int number) {
  JobOutcome outcome = made_up_outcome(number);
  outcome.error_kind = ErrorKind::transient_io;
  outcome.verdict = "FAILED";
  outcome.verdict_reason.clear();
  outcome.error = "corrected/a \"b\".ngc: error: cannot write the file:\n\tNo space left on device";
  outcome.outputs.clear();
  outcome.before_mm = outcome.after_mm = outcome.corrected_percent = std::nullopt;
  return outcome;
}

inline Manifest made_up_manifest(int jobs) {
  Manifest manifest{.version = "0.1.0", .plan = sha256("plan")};
  for (int number = 0; number < jobs; ++number)
    manifest.jobs.push_back(number % 3 == 2 ? failed_outcome(number) : made_up_outcome(number));
  return manifest;
}

}  // namespace counterflex::test
