#include "watch_job.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "compensate.hpp"
#include "guarded.hpp"
#include "outputs.hpp"

namespace counterflex::cli {
namespace {

std::string in_folder(const std::string& folder, const std::filesystem::path& name) {
  return (std::filesystem::path(folder) / name).string();
}

std::string line_of(const WatchResult& result) {
  nlohmann::json json{{"exit", static_cast<int>(result.exit)}, {"error", result.error}};
  if (result.before_mm) json["before_mm"] = *result.before_mm;
  if (result.after_mm) json["after_mm"] = *result.after_mm;
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::optional<double> number_in(const nlohmann::json& json, const char* key) {
  return json.contains(key) ? std::optional(json[key].get<double>()) : std::nullopt;
}

}  // namespace

Options watch_job(const Options& watch, const std::string& program) {
  const std::filesystem::path path(program);
  Options job = watch;
  job.command = Command::compensate;
  job.program = program;
  job.json = false;  // of the watch: a line for each program
  if (watch.output) job.output = in_folder(*watch.output, path.filename());
  if (watch.report) job.report = in_folder(*watch.report, path.stem());
  if (watch.plot) job.plot = in_folder(*watch.plot, path.stem().string() + ".svg");
  return job;
}

std::string watch_output(const Options& job) {
  return job.output.value_or(default_output(job.program));
}

void do_watch_job(const Options& job, const SendLine& send) {
  WatchResult result;
  const auto hear_error = [&](std::string_view diagnostic) {
    if (result.error.empty()) result.error = diagnostic;
  };
  Console console(job, {.error = hear_error});
  const auto tell = [&](const Run& run, const RunEnd& end, const RunFiles&) {
    console.finish_warnings();
    if (end.report.before) result.before_mm = end.report.before->max_mm;
    if (end.report.after) result.after_mm = end.report.after->max_mm;
    return exit_of(run, end.report.failure, console);
  };
  result.exit = guarded(console, [&] { return compensate_program(job, console, tell); });
  send(line_of(result));
}

WatchResult watch_result(const std::optional<std::string>& sent, const Options& job, int ending) {
  if (!sent)
    return {Exit::internal,
            fmt::format("{}: error: its run {} without a result", job.program, ending_text(ending)),
            {},
            {}};
  const auto json = nlohmann::json::parse(*sent);
  return {static_cast<Exit>(json["exit"].get<int>()), json["error"], number_in(json, "before_mm"),
          number_in(json, "after_mm")};
}

}  // namespace counterflex::cli
