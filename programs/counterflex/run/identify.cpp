#include "run/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

#include "counterflex/files/files.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/report/identification.hpp"
#include "process/read_input.hpp"
#include "process/version.hpp"
#include "run/job_files.hpp"
#include "run/program_places.hpp"

namespace counterflex::cli {
namespace {

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

constexpr int next_count = 3;

/// Whether all rows are deflections under a load, in which errors of geometry hardly show: a fit of these
/// would only fit noise.
bool are_deflections(const Measurements& measurements) {
  return std::all_of(measurements.sessions.begin(), measurements.sessions.end(), [](const Session& session) {
    return session.kind == MeasurementKind::static_push || session.kind == MeasurementKind::hung_weight;
  });
}

/// The rows of a file that is read twice would count twice.
void refuse_data_twice(const std::vector<std::string>& files) {
  std::set<std::string> seen;
  for (const std::string& file : files)
    if (!seen.insert(canonical_name(file)).second)
      throw InputError(ErrorKind::usage, {file},
                       "--data names this file twice, and its rows would count twice: name each file once");
}

/// Of --for, if it is given.
std::optional<Failure> places_for(const Options& options, const MachineInput& machine, Console& console,
                                  std::vector<ProgramPlace>& places) {
  if (options.identify.program.empty()) return std::nullopt;
  Options run = options;
  run.program = options.identify.program;
  run.report.reset();
  return find_program_places(run, machine, console, places);
}

/// Throws (ErrorKind::usage).
IdentifyOptions identify_options(const Options& options) {
  IdentifyOptions wanted;
  if (options.identify.fit) wanted.sets = sets_of(*options.identify.fit);
  if (options.identify.hold_out) wanted.hold_out = hold_out_of(*options.identify.hold_out);
  wanted.ladder = !options.identify.all;
  wanted.threads = options.threads;
  return wanted;
}

}  // namespace

std::string identified_text(std::string_view text, const std::string& file, const Identification& found,
                            const std::vector<std::string>& measurements) {
  constexpr std::string_view mark = "# Identified by counterflex";
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (text.starts_with(mark)) text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  const std::string files = names_of(measurements);
  return fmt::format("{} {} from {}\n{}", mark, version, files, with_identified(text, file, found, files));
}

std::string names_of(const std::vector<std::string>& files) {
  std::string text;
  for (const std::string& file : files)
    text += (text.empty() ? "" : ", ") +
            without_controls(std::filesystem::path(file).filename().generic_string());
  return text;
}

void refuse_wrong_values(const Options& options) {
  identify_options(options);
}

std::optional<ErrorKind> identify_run(const Options& options, const MachineInput& input, Console& console,
                                      Identification& found) {
  IdentifyOptions wanted = identify_options(options);
  if (const std::string& prior = options.identify.prior; !prior.empty())
    wanted.prior = read_covariance(read_input(prior, ErrorKind::machine_or_force), prior, input.machine);
  refuse_data_twice(options.identify.data);
  Measurements measurements;
  or_unreadable(ErrorKind::machine_or_force, [&] {
    for (const std::string& file : options.identify.data)
      load_measurements(file, input.machine, measurements);
  });
  if (measurements.empty_rows > 0)
    console.note(
        fmt::format("{} rows of sheets have no measured value and are skipped\n", measurements.empty_rows));
  if (!options.identify.fit && !measurements.rows.empty() && are_deflections(measurements)) {
    wanted.sets = {ParameterSet::compliance};
    console.note("the rows are pushes and weights: only compliances are fitted (default of --fit)\n");
  }
  std::vector<ProgramPlace> places;
  if (const auto failure = places_for(options, input, console, places)) return failure->kind;
  console.progress("identifying");
  found = identify(input.machine, measurements, wanted);
  if (!places.empty()) {
    found.program = next_measurements(found.machine, known_parameters(found), places,
                                      candidate_measurements(found.machine, measurements, places), next_count,
                                      options.threads);
    found.program->program = names_of({options.identify.program});
  }
  return std::nullopt;
}

}  // namespace counterflex::cli
