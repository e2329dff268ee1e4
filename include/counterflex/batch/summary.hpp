#pragma once
/// What a batch has come to: for people, and for programs.
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/batch/job_outcome.hpp"

namespace counterflex {

/// Whether a job that ended so would fail again with the same inputs: it was understood and refused.
bool fails_again(Exit exit);

/// The outcomes, worst first: those that failed, those whose verdict PARTLY was accepted, then by the
/// deviation that is left, then by the one before, the largest first; equal ones by the path of the program.
std::vector<JobOutcome> worst_first(std::vector<JobOutcome> outcomes);

/// "done", or what failed, in a few words: "not within tolerance".
std::string_view status_text(Exit exit);

/// The same; of a job whose verdict is PARTLY or NOTHING CORRECTED, that.
std::string_view status_text(const JobOutcome& outcome);

/// The status of a batch: 0 where all are done; 75 where one may succeed if it is tried again; else the
/// smallest of those that failed.
Exit exit_of(const std::vector<JobOutcome>& outcomes);

/// One table of at most `most_rows` jobs, worst first, with what is to be known of the others, and the
/// diagnostics of these that failed. Lengths in mm.
std::string summary_table(const std::vector<JobOutcome>& outcomes, std::size_t most_rows);

/// {"schema": "counterflex-batch 1", "tool", "counts": {"jobs", "done", "partly", "failed"},
/// "exit_status", "jobs": [{"program", "output", "verdict", "verdict_reason", "status", "exit_status",
/// "error", "before_mm", "after_mm", "corrected_percent", "warnings", "moves", "inputs": [{"path",
/// "sha256"}], "outputs": [...]}]}, worst first. `version` is the tool's.
std::string summary_json(const std::vector<JobOutcome>& outcomes, std::string_view version);

/// The first row of the table of jobs.
inline constexpr std::string_view summary_columns =
    "program,output,status,exit_status,before_mm,after_mm,corrected_percent,warnings,moves,error,verdict,"
    "verdict_reason";

/// The same jobs as rows of `summary_columns`; fields quoted as RFC 4180 has it.
std::string summary_csv(const std::vector<JobOutcome>& outcomes);

}  // namespace counterflex
