#include "run/identify.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "commands/commands.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/files.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/report/identification.hpp"
#include "process/standard_output.hpp"
#include "process/version.hpp"
#include "run/command_outputs.hpp"
#include "run/inputs.hpp"
#include "run/output_paths.hpp"
#include "run/run.hpp"
#include "run/run_files.hpp"

namespace counterflex::cli {
namespace {

constexpr std::string_view report_mark = "counterflex-identification 1",
                           page_mark = "counterflex identification";

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

/// A machine file has a deviation for each parameter, not how these depend on each other.
std::string covariance_words(const Identification& found, const OutputFiles& files) {
  if (files.machine.empty() || (found.free.empty() && found.correlations.empty())) return "";
  return fmt::format(
      "             deviations in {} depend on each other: bands need covariance = \"{}\" in "
      "[uncertainty]{}\n",
      without_controls(files.machine), files.report.empty() ? "STEM.json" : without_controls(files.report),
      files.report.empty() ? "; --report STEM writes that file" : "");
}

/// The files, and the result for the terminal or a pipe.
void write_files(const Options& options, const MachineInput& machine, const Identification& found,
                 const OutputFiles& files) {
  const std::string data = names_of(options.identify.data);
  std::optional<FileWriter> machine_file, json_file, page_file;
  if (!files.machine.empty()) {
    machine_file.emplace(files.machine);
    machine_file->write(
        identified_text(machine.text, shown_name(options.machine), found, options.identify.data));
  }
  if (!files.report.empty()) {
    json_file.emplace(files.report);
    json_file->write(to_json(found));
    page_file.emplace(files.page);
    page_file->write(identification_page(found, machine.machine.name, data));
  }
  output_files(options);  // again: a foreign file may have appeared
  publish_together({if_any(machine_file), if_any(json_file), if_any(page_file)});
  if (files.machine == "-") return;
  if (options.json) return write_result(to_json(found));
  std::string written;
  for (const std::string& file : {files.machine, files.report, files.page})
    if (!file.empty()) written += (written.empty() ? "" : ", ") + without_controls(file);
  write_result(to_text(found, options.verbose) +
               (written.empty() ? "" : fmt::format("\nwritten      {}\n", written)) +
               covariance_words(found, files));
}

}  // namespace

std::optional<ErrorKind> run_identify(const Options& options, Console& console) {
  refuse_wrong_values(options);
  refuse_stdin_twice(options);
  const OutputFiles files = output_files(options);
  const MachineInput input = read_machine_input(options);
  Identification found;
  if (const auto error = identify_run(options, input, console, found)) return error;
  write_files(options, input, found, files);
  return {};
}

}  // namespace counterflex::cli
