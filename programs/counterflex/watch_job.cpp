#include "watch_job.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "compensate.hpp"
#include "counterflex/files/temporaries.hpp"
#include "guarded.hpp"
#include "layers.hpp"
#include "output_names.hpp"
#include "outputs.hpp"
#include "watch_claims.hpp"

namespace counterflex::cli {
namespace {

namespace fs = std::filesystem;

std::string line_of(const WatchResult& result) {
  nlohmann::json json{{"exit", static_cast<int>(result.exit)},
                      {"error", result.error},
                      {"verdict", result.verdict},
                      {"verdict_reason", result.verdict_reason}};
  if (result.before_mm) json["before_mm"] = *result.before_mm;
  if (result.after_mm) json["after_mm"] = *result.after_mm;
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::optional<double> number_in(const nlohmann::json& json, const char* key) {
  return json.contains(key) ? std::optional(json[key].get<double>()) : std::nullopt;
}

/// The temporary files that `process` has made of `output`: those of other processes may be in use.
std::vector<fs::path> left_by(pid_t process, const std::string& output) {
  std::error_code error;
  const fs::path target = fs::canonical(output, error);
  const fs::path file = error ? fs::path(output) : target;
  const std::string wanted = temporary_stem(file.filename().string()), start = fmt::format("{}.{}-", wanted, process);
  std::vector<fs::path> left;
  for (fs::directory_iterator entry(file.has_parent_path() ? file.parent_path() : ".", error), end;
       !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(start) && wanted_name(name) == wanted) left.push_back(entry->path());
  }
  return left;
}

[[noreturn]] void refuse_shared(const char* option, const std::string& path) {
  throw InputError(
      Exit::usage, {},
      fmt::format("{} of every program would be {}; name a folder, which ends in /, or a pattern, "
                  "as {{name}}_CF{{ext}}",
                  option, path));
}

}  // namespace

Options watch_job(const Options& watch, const std::string& program) {
  Options job = options_of(Command::compensate, layers_of(watch.sources, program).layers, program);
  job.quiet = watch.quiet;
  job.verbose = watch.verbose;
  return job;
}

std::string watch_output(const Options& job) {
  return job.output.value_or(default_output(job.program));
}

void refuse_shared_outputs(const Options& watch) {
  const std::filesystem::path folder(watch.folder);
  const Options one = watch_job(watch, (folder / "one.nc").string());
  const Options other = watch_job(watch, (folder / "other.nc").string());
  if (watch_output(one) == watch_output(other)) refuse_shared("--output", watch_output(one));
  if (one.report && one.report == other.report) refuse_shared("--report", *one.report);
  if (one.plot && one.plot == other.plot) refuse_shared("--plot", *one.plot);
  std::error_code error;
  if (std::filesystem::weakly_canonical(watch_output(one), error) ==
      std::filesystem::weakly_canonical(one.program, error))
    throw InputError(Exit::usage, {watch.folder},
                     "corrected programs would replace their originals: name another folder with --output");
}

void do_watch_job(const Options& job, const SendLine& send) {
  send(nlohmann::json{{"process", ::getpid()}}.dump());
  WatchResult result;
  const auto hear_error = [&](std::string_view diagnostic) {
    if (result.error.empty()) result.error = with_file(std::string(diagnostic), job.program);
  };
  Console console(job, {.error = hear_error});
  const auto tell = [&](const Run& run, const RunEnd& end, const RunFiles&) {
    console.finish_warnings();
    if (end.report.before) result.before_mm = end.report.before->max_mm;
    if (end.report.after) result.after_mm = end.report.after->max_mm;
    result.verdict = to_string(end.report.verdict);
    result.verdict_reason = end.report.verdict_reason;
    return exit_of(run, end.report, console);
  };
  result.exit = guarded(console, [&] { return compensate_program(job, console, tell); });
  send(line_of(result));
}

pid_t process_of_watch_job(const std::string& sent) {
  const auto json = nlohmann::json::parse(sent);
  return json.contains("process") ? json["process"].get<pid_t>() : 0;
}

void sweep_after(pid_t killed, const Options& job) {
  std::error_code ignored;
  for (const std::string& output : files_of_watch_job(job))
    for (const fs::path& file : left_by(killed, output)) fs::remove(file, ignored);
}

WatchResult watch_result(const std::optional<std::string>& sent, const Options& job, int ending) {
  if (!sent)
    return {Exit::internal,
            fmt::format("{}: error: its run {} without a result", job.program, ending_text(ending)),
            {},
            {}};
  const auto json = nlohmann::json::parse(*sent);
  return {static_cast<Exit>(json["exit"].get<int>()),
          json["error"],
          number_in(json, "before_mm"),
          number_in(json, "after_mm"),
          json["verdict"],
          json["verdict_reason"]};
}

}  // namespace counterflex::cli
