#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "batch/job_line.hpp"
#include "counterflex/batch/manifest.hpp"

namespace counterflex {
namespace {

using LineJson = nlohmann::ordered_json;

struct UnknownStatus {
  int number;
};

LineJson json_of(const std::vector<FileHash>& files) {
  LineJson list = LineJson::array();
  for (const FileHash& file : files)
    list.push_back({{"path", utf8_of_bytes(file.path)}, {"sha256", utf8_of_bytes(file.sha256)}});
  return list;
}

template <typename Number>
LineJson json_of(const std::optional<Number>& value) {
  return value ? LineJson(*value) : LineJson();
}

std::string text_at(const LineJson& object, const char* key) {
  return bytes_of_utf8(object.at(key).get_ref<const std::string&>());
}

std::vector<FileHash> files_at(const LineJson& object, const char* key) {
  std::vector<FileHash> files;
  for (const LineJson& file : object.at(key).get_ref<const LineJson::array_t&>())
    files.push_back({text_at(file, "path"), text_at(file, "sha256")});
  return files;
}

template <typename Number>
std::optional<Number> number_at(const LineJson& object, const char* key) {
  const LineJson& value = object.at(key);
  if (value.is_null()) return std::nullopt;
  return value.get<Number>();
}

/// The error of a job that ended with the exit status `number`. Throws `UnknownStatus` for a number that no
/// kind of error has.
std::optional<ErrorKind> error_of_number(int number, ExitStatusOf exit_status) {
  if (number == 0) return std::nullopt;
  for (const ErrorKind kind : error_kinds)
    if (exit_status(kind) == number) return kind;
  throw UnknownStatus{number};
}

JobOutcome outcome_from(const LineJson& object, ExitStatusOf exit_status) {
  JobOutcome outcome;
  outcome.key = text_at(object, "key");
  outcome.program = text_at(object, "program");
  outcome.output = text_at(object, "output");
  outcome.error_kind = error_of_number(object.at("exit").get<int>(), exit_status);
  outcome.verdict = text_at(object, "verdict");
  outcome.verdict_reason = text_at(object, "verdict_reason");
  outcome.error = text_at(object, "error");
  outcome.inputs = files_at(object, "inputs");
  outcome.outputs = files_at(object, "outputs");
  outcome.before_mm = number_at<double>(object, "before_mm");
  outcome.after_mm = number_at<double>(object, "after_mm");
  outcome.corrected_percent = number_at<double>(object, "corrected_percent");
  outcome.warnings = number_at<std::size_t>(object, "warnings");
  outcome.moves = number_at<std::size_t>(object, "moves");
  return outcome;
}

/// The first column, from 1, in which two texts differ. Neither text is a prefix of the other.
std::size_t first_difference(std::string_view a, std::string_view b) {
  const auto shorter = static_cast<std::ptrdiff_t>(std::min(a.size(), b.size()));
  return static_cast<std::size_t>(std::mismatch(a.begin(), a.begin() + shorter, b.begin()).first -
                                  a.begin()) +
         1;
}

/// The message of the library without its number and place.
std::string without_name(const LineJson::exception& error) {
  std::string_view text = error.what();
  for (const std::string_view before : {std::string_view("] "), std::string_view(": syntax error ")})
    if (const std::size_t at = text.find(before); at != std::string_view::npos)
      text.remove_prefix(at + before.size());
  return std::string(text);
}

}  // namespace

std::string to_json_line(const JobOutcome& outcome, ExitStatusOf exit_status) {
  LineJson object;
  object["key"] = utf8_of_bytes(outcome.key);
  object["program"] = utf8_of_bytes(outcome.program);
  object["output"] = utf8_of_bytes(outcome.output);
  object["exit"] = exit_number(outcome.error_kind, exit_status);
  object["verdict"] = utf8_of_bytes(outcome.verdict);
  object["verdict_reason"] = utf8_of_bytes(outcome.verdict_reason);
  object["error"] = utf8_of_bytes(outcome.error);
  object["inputs"] = json_of(outcome.inputs);
  object["outputs"] = json_of(outcome.outputs);
  object["before_mm"] = json_of(outcome.before_mm);
  object["after_mm"] = json_of(outcome.after_mm);
  object["corrected_percent"] = json_of(outcome.corrected_percent);
  object["warnings"] = json_of(outcome.warnings);
  object["moves"] = json_of(outcome.moves);
  return object.dump();
}

std::variant<JobOutcome, LineTrouble> read_job_line(std::string_view line, ExitStatusOf exit_status) {
  try {
    JobOutcome outcome = outcome_from(LineJson::parse(line), exit_status);
    const std::string written = to_json_line(outcome, exit_status);
    if (written == line) return outcome;
    return LineTrouble{first_difference(line, written), "the line is not as counterflex writes it"};
  } catch (const LineJson::parse_error& error) {
    return LineTrouble{std::max<std::size_t>(error.byte, 1), "the line is not JSON: " + without_name(error)};
  } catch (const LineJson::exception& error) {
    return LineTrouble{1, "the line is not that of a job: " + without_name(error)};
  } catch (const UnknownStatus& unknown) {
    return LineTrouble{
        1, fmt::format("the line is not that of a job: no job ends with exit status {}", unknown.number)};
  }
}

JobOutcome outcome_of(std::string_view line, ExitStatusOf exit_status) {
  auto read = read_job_line(line, exit_status);
  if (const auto* trouble = std::get_if<LineTrouble>(&read))
    throw InputError(ErrorKind::internal, {},
                     fmt::format("the outcome of a job cannot be read: {}", trouble->what));
  return std::get<JobOutcome>(std::move(read));
}

}  // namespace counterflex
