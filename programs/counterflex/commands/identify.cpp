#include "counterflex/identify/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "commands/commands.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/report/identification.hpp"
#include "process/standard_output.hpp"
#include "process/version.hpp"
#include "run/inputs.hpp"
#include "run/outputs.hpp"
#include "run/program_places.hpp"

namespace counterflex::cli {
namespace {

constexpr std::string_view mark = "# Identified by counterflex";
constexpr std::string_view report_mark = "counterflex-identification 1",
                           page_mark = "counterflex identification";

/// "zeros,geometry,compliance,mass,reversal,tables,harmonics", in the order of ParameterSet. Throws
/// (ErrorKind::usage).
std::vector<ParameterSet> sets_of(const std::string& text) {
  std::vector<ParameterSet> sets;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string name = text.substr(begin, end - begin);
    constexpr std::array names = {"zeros",    "geometry", "compliance", "mass",
                                  "reversal", "tables",   "harmonics"};
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      throw InputError(ErrorKind::usage, {},
                       fmt::format("--fit has '{}'; use a list of zeros, geometry, compliance, mass, "
                                   "reversal, tables and harmonics",
                                   name));
    sets.push_back(static_cast<ParameterSet>(found - names.begin()));
    begin = end + 1;
  }
  return sets;
}

HoldOut hold_out_of(const std::string& text) {
  if (text == "session") return HoldOut::session;
  if (text == "region") return HoldOut::region;
  if (text == "20%") return HoldOut::fifth;
  throw InputError(ErrorKind::usage, {}, fmt::format("--hold-out is '{}'; use session, region or 20%", text));
}

/// "series_B.csv, series_C.csv": names without folders, so that the file is the same wherever it is made.
std::string names_of(const std::vector<std::string>& files) {
  std::string text;
  for (const std::string& file : files)
    text += (text.empty() ? "" : ", ") + without_controls(std::filesystem::path(file).filename().string());
  return text;
}

/// The text without a first line that an earlier run wrote.
std::string_view without_mark(std::string_view text) {
  if (!text.starts_with(mark)) return text;
  const std::size_t end = text.find('\n');
  return end == std::string_view::npos ? "" : text.substr(end + 1);
}

constexpr int next_count = 3;

/// Whether all rows are deflections under a load, in which errors of geometry hardly show: a fit of these
/// would only fit noise.
bool are_deflections(const Measurements& measurements) {
  return std::all_of(measurements.sessions.begin(), measurements.sessions.end(), [](const Session& session) {
    return session.kind == MeasurementKind::static_push || session.kind == MeasurementKind::hung_weight;
  });
}

/// Of --for, if it is given.
std::optional<Failure> places_for(const Options& options, Console& console,
                                  std::vector<ProgramPlace>& places) {
  if (options.identify.program.empty()) return std::nullopt;
  Options run = options;
  run.command = Command::predict;
  run.program = options.identify.program;
  run.report.reset();
  return find_program_places(run, console, places);
}

/// Empty where nothing is written.
struct OutputFiles {
  std::string machine, report, page;
};

/// Throws `InputError` for a file that is an input, too, or that another program wrote.
OutputFiles output_files(const Options& options) {
  OutputFiles files{options.output.value_or(""), "", ""};
  if (options.report) files.report = *options.report + ".json", files.page = *options.report + ".html";
  std::vector<std::string> inputs = options.identify.data;
  inputs.push_back(options.machine);
  for (const std::string& more : {options.identify.program, options.identify.prior})
    if (!more.empty()) inputs.push_back(more);
  check_machine_output(files.machine, inputs, options.force_overwrite);
  for (const std::string& input : inputs)
    for (const std::string& file : {files.report, files.page})
      if (!file.empty() && canonical_name(file) == canonical_name(input))
        throw InputError(ErrorKind::usage, {}, fmt::format("{} is an input and an output", file));
  if (!options.force_overwrite)
    refuse_foreign({marked_file(files.report, report_mark), marked_file(files.page, page_mark)});
  return files;
}

/// The files, and the result for the terminal or a pipe.
void write_files(const Options& options, const Machine& machine, const Identification& found,
                 const OutputFiles& files) {
  const std::string data = names_of(options.identify.data);
  std::optional<FileWriter> machine_file, json_file, page_file;
  if (!files.machine.empty()) {
    const std::string text = read_file(options.machine);
    machine_file.emplace(files.machine);
    machine_file->write(fmt::format("{} {} from {}\n", mark, version, data));
    machine_file->write(with_identified(without_mark(text), options.machine, found, data));
  }
  if (!files.report.empty()) {
    json_file.emplace(files.report);
    json_file->write(to_json(found));
    page_file.emplace(files.page);
    page_file->write(identification_page(found, machine.name, data));
  }
  publish_together({if_any(machine_file), if_any(json_file), if_any(page_file)});
  if (files.machine == "-") return;
  if (options.json) return write_result(to_json(found));
  std::string written;
  for (const std::string& file : {files.machine, files.report, files.page})
    if (!file.empty()) written += (written.empty() ? "" : ", ") + without_controls(file);
  write_result(to_text(found, options.verbose) +
               (written.empty() ? "" : fmt::format("\nwritten      {}\n", written)));
}

}  // namespace

std::optional<ErrorKind> run_identify(const Options& options, Console& console) {
  IdentifyOptions wanted;
  if (options.identify.fit) wanted.sets = sets_of(*options.identify.fit);
  if (options.identify.hold_out) wanted.hold_out = hold_out_of(*options.identify.hold_out);
  wanted.ladder = !options.identify.all;
  wanted.threads = options.threads;
  const OutputFiles files = output_files(options);
  const MachineInput input = read_machine_input(options);
  if (const std::string& prior = options.identify.prior; !prior.empty())
    wanted.prior = read_covariance(read_file(prior), prior, input.machine);
  Measurements measurements;
  for (const std::string& file : options.identify.data) load_measurements(file, input.machine, measurements);
  if (measurements.empty_rows > 0)
    console.note(
        fmt::format("{} rows of sheets have no measured value and are skipped\n", measurements.empty_rows));
  if (!options.identify.fit && !measurements.rows.empty() && are_deflections(measurements)) {
    wanted.sets = {ParameterSet::compliance};
    console.note("the rows are pushes and weights: only compliances are fitted (default of --fit)\n");
  }
  std::vector<ProgramPlace> places;
  if (const auto failure = places_for(options, console, places)) return failure->kind;
  console.progress("identifying");
  Identification found = identify(input.machine, measurements, wanted);
  if (!places.empty()) {
    found.program = next_measurements(found.machine, known_parameters(found), places,
                                      candidate_measurements(found.machine, measurements, places), next_count,
                                      options.threads);
    found.program->program = names_of({options.identify.program});
  }
  write_files(options, input.machine, found, files);
  return {};
}

}  // namespace counterflex::cli
