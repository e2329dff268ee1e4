#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "batch/job_line.hpp"
#include "counterflex/batch/manifest.hpp"
#include "counterflex/files/text.hpp"

namespace counterflex {
namespace {

constexpr int shown_digits = 6;  // of a length in mm: hides rounding noise

bool is_done(const JobOutcome& outcome) {
  return !outcome.error_kind;
}

/// Whether its program was written though it is not within the tolerance everywhere.
bool is_partly(const JobOutcome& outcome) {
  return is_done(outcome) && outcome.verdict != "OK";
}

std::size_t count_partly(const std::vector<JobOutcome>& outcomes) {
  return static_cast<std::size_t>(std::count_if(outcomes.begin(), outcomes.end(), is_partly));
}

std::size_t count_done(const std::vector<JobOutcome>& outcomes) {
  return static_cast<std::size_t>(std::count_if(outcomes.begin(), outcomes.end(), is_done));
}

using Document = nlohmann::ordered_json;

Document number_or_null(const std::optional<double>& value, int decimals) {
  return value ? Document(rounded(*value, decimals)) : Document();
}

Document count_or_null(const std::optional<std::size_t>& count) {
  return count ? Document(*count) : Document();
}

Document files_of(const std::vector<FileHash>& files) {
  Document list = Document::array();
  for (const FileHash& file : files) list.push_back({{"path", file.path}, {"sha256", file.sha256}});
  return list;
}

Document job_of(const JobOutcome& outcome, ExitStatusOf exit_status) {
  Document job;
  job["program"] = outcome.program;
  job["output"] = outcome.output;
  job["verdict"] = outcome.verdict;
  job["verdict_reason"] = outcome.verdict_reason;
  job["status"] = status_text(outcome);
  job["exit_status"] = exit_number(outcome.error_kind, exit_status);
  job["error"] = outcome.error.empty() ? Document() : Document(outcome.error);
  job["before_mm"] = number_or_null(outcome.before_mm, shown_digits);
  job["after_mm"] = number_or_null(outcome.after_mm, shown_digits);
  job["corrected_percent"] = number_or_null(outcome.corrected_percent, 2);
  job["warnings"] = count_or_null(outcome.warnings);
  job["moves"] = count_or_null(outcome.moves);
  job["inputs"] = files_of(outcome.inputs);
  job["outputs"] = files_of(outcome.outputs);
  return job;
}

/// A CSV field, quoted as in RFC 4180. A text that a spreadsheet would take for a formula gets an apostrophe.
std::string csv_field(std::string_view field) {
  std::string text = without_controls(field);
  const std::size_t first = text.find_first_not_of(' ');
  if (first != std::string::npos && std::string_view("=+-@").find(text[first]) != std::string_view::npos)
    text.insert(0, 1, '\'');
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + '"';
}

std::string fixed_or(const std::optional<double>& value, int decimals, std::string_view none) {
  return value ? format_fixed(*value, decimals) : std::string(none);
}

std::string count_or(const std::optional<std::size_t>& count, std::string_view none) {
  return count ? fmt::format("{}", *count) : std::string(none);
}

std::string row_of(const JobOutcome& outcome) {
  const std::string percent =
      outcome.corrected_percent ? fixed_or(outcome.corrected_percent, 1, "") + " %" : "-";
  return fmt::format("{:<19}{:<22}{:>11}{:>11}{:>11}{:>10}  {}\n", outcome.verdict, status_text(outcome),
                     fixed_or(outcome.before_mm, 4, "-"), fixed_or(outcome.after_mm, 4, "-"), percent,
                     count_or(outcome.warnings, "-"), without_controls(outcome.program));
}

std::string heading() {
  return fmt::format("{:<19}{:<22}{:>11}{:>11}{:>11}{:>10}  {}\n", "verdict", "status", "before mm",
                     "after mm", "corrected", "warnings", "program");
}

}  // namespace

bool fails_again(ErrorKind error) {
  return error == ErrorKind::program_text || error == ErrorKind::machine_or_force ||
         error == ErrorKind::not_compensated || error == ErrorKind::limit;
}

std::vector<JobOutcome> worst_first(std::vector<JobOutcome> outcomes) {
  const auto badness = [](const JobOutcome& outcome) {
    constexpr double none = -std::numeric_limits<double>::infinity();
    return std::tuple(is_done(outcome), !is_partly(outcome), -outcome.after_mm.value_or(none),
                      -outcome.before_mm.value_or(none));
  };
  std::sort(outcomes.begin(), outcomes.end(), [&](const JobOutcome& a, const JobOutcome& b) {
    return std::tuple(badness(a), std::string_view(a.program), std::string_view(a.output)) <
           std::tuple(badness(b), std::string_view(b.program), std::string_view(b.output));
  });
  return outcomes;
}

std::string_view status_text(const std::optional<ErrorKind>& error) {
  if (!error) return "done";
  switch (*error) {
    case ErrorKind::internal:
      return "internal error";
    case ErrorKind::usage:
      return "cannot be run";
    case ErrorKind::program_text:
      return "program refused";
    case ErrorKind::machine_or_force:
      return "machine or force file";
    case ErrorKind::not_compensated:
      return "not within tolerance";
    case ErrorKind::limit:
      return "limit exceeded";
    case ErrorKind::transient_io:
      return "input or output";
  }
  return "failed";
}

std::string_view status_text(const JobOutcome& outcome) {
  if (is_partly(outcome)) return "partly accepted";
  if (outcome.verdict == "NOTHING CORRECTED") return "nothing corrected";
  return outcome.verdict == "PARTLY" ? "partly, not accepted" : status_text(outcome.error_kind);
}

std::optional<ErrorKind> error_of(const std::vector<JobOutcome>& outcomes) {
  std::optional<ErrorKind> first;
  for (const JobOutcome& outcome : outcomes) {
    if (outcome.error_kind == ErrorKind::transient_io) return ErrorKind::transient_io;
    if (!is_done(outcome)) first = std::min(first.value_or(*outcome.error_kind), *outcome.error_kind);
  }
  return first;
}

std::string summary_table(const std::vector<JobOutcome>& outcomes, std::size_t most_rows) {
  const std::vector<JobOutcome> rows = worst_first(outcomes);
  const std::size_t shown = std::min(rows.size(), most_rows);
  std::string text = heading();
  for (std::size_t i = 0; i < shown; ++i) {
    text += row_of(rows[i]);
    if (!rows[i].verdict_reason.empty()) text += fmt::format("  {}\n", rows[i].verdict_reason);
  }
  if (shown < rows.size())
    text += fmt::format("and {} more with smaller or equal deviations\n", rows.size() - shown);
  const std::size_t partly = count_partly(rows), written = count_done(rows), failed = rows.size() - written;
  text += fmt::format("\n{} of {} jobs done{}{}\n", written - partly, rows.size(),
                      partly > 0 ? fmt::format(", {} partly", partly) : "",
                      failed > 0 ? fmt::format(", {} failed", failed) : "");
  for (std::size_t i = 0; i < shown && !is_done(rows[i]); ++i)
    text += fmt::format("  {}\n", without_controls(rows[i].error));
  return text;
}

std::string summary_json(const std::vector<JobOutcome>& outcomes, std::string_view version,
                         ExitStatusOf exit_status) {
  const std::size_t written = count_done(outcomes), partly = count_partly(outcomes);
  Document document;
  document["schema"] = "counterflex-batch 1";
  document["tool"] = fmt::format("counterflex {}", version);
  document["counts"] = {{"jobs", outcomes.size()},
                        {"done", written - partly},
                        {"partly", partly},
                        {"failed", outcomes.size() - written}};
  document["exit_status"] = exit_number(error_of(outcomes), exit_status);
  document["jobs"] = Document::array();
  for (const JobOutcome& outcome : worst_first(outcomes))
    document["jobs"].push_back(job_of(outcome, exit_status));
  return document.dump(2, ' ', false, Document::error_handler_t::replace) + "\n";
}

std::string summary_csv(const std::vector<JobOutcome>& outcomes, ExitStatusOf exit_status) {
  std::string text = std::string(summary_columns) + "\n";
  for (const JobOutcome& outcome : worst_first(outcomes))
    text += fmt::format(
        "{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_field(outcome.program), csv_field(outcome.output),
        csv_field(status_text(outcome)), exit_number(outcome.error_kind, exit_status),
        fixed_or(outcome.before_mm, shown_digits, ""), fixed_or(outcome.after_mm, shown_digits, ""),
        fixed_or(outcome.corrected_percent, 2, ""), count_or(outcome.warnings, ""),
        count_or(outcome.moves, ""), csv_field(outcome.error), outcome.verdict,
        csv_field(outcome.verdict_reason));
  return text;
}

}  // namespace counterflex
