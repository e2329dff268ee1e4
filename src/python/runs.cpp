/// Runs of the commands on texts in memory: what they write comes back instead of files.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "counterflex/files/text.hpp"
#include "counterflex/identify/identify.hpp"
#include "counterflex/report/identification.hpp"
#include "loaded_machine.hpp"
#include "run/compensate.hpp"
#include "run/identify.hpp"
#include "run/predict.hpp"
#include "run/verify.hpp"
#include "settings/layers.hpp"
#include "settings/setting_options.hpp"

namespace counterflex::python {
namespace py = pybind11;
namespace {

/// Options of the command line by their long names, with their values as texts.
using GivenOptions = std::vector<std::pair<std::string, std::vector<std::string>>>;

cli::Options options_of(cli::Command command, const LoadedMachine& machine, const std::string& program,
                        const GivenOptions& given) {
  std::vector<Setting> settings;
  for (const auto& [option, values] : given) settings.push_back({option, values, {}, Origin::environment});
  cli::Options options;
  options.command = command;
  options.program = program;
  options.machine = machine.input.file.path;
  return cli::with_settings(std::move(options), {settings});
}

cli::MachineInput ready(const cli::Options& options, const LoadedMachine& machine) {
  return cli::ready_machine(options, machine.input.file, machine.input.machine);
}

std::vector<std::string> split_row(std::string_view row) {
  std::vector<std::string> cells;
  for (;;) {
    const std::size_t comma = row.find(',');
    cells.emplace_back(row.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    row.remove_prefix(comma + 1);
  }
}

/// The rows of the CSV report as numbers, and their statuses.
class Waypoints {
 public:
  /// Whole lines; the first one has the names of the columns.
  void add(std::string_view lines) {
    while (!lines.empty()) {
      const std::size_t end = lines.find('\n');
      add_line(lines.substr(0, end));
      lines.remove_prefix(end + 1);
    }
  }

  py::tuple as_python() const {
    const auto columns = static_cast<py::ssize_t>(names_.size());
    const auto rows = static_cast<py::ssize_t>(statuses_.size());
    py::array_t<double> table({rows, columns});
    std::copy(numbers_.begin(), numbers_.end(), table.mutable_data());
    return py::make_tuple(names_, table, statuses_);
  }

 private:
  void add_line(std::string_view line) {
    std::vector<std::string> cells = split_row(line);
    if (names_.empty()) {
      names_ = std::move(cells);
      return;
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (names_[i] == "status") statuses_.push_back(cells[i]);
      numbers_.push_back(read_number(cells[i]).value_or(std::numeric_limits<double>::quiet_NaN()));
    }
  }

  std::vector<std::string> names_, statuses_;
  std::vector<double> numbers_;  ///< row by row
};

/// What a run gives back.
struct Outcome {
  std::string program, report;
  bool is_done = false;  ///< without an error: only then is a program written
  Waypoints waypoints;
  std::vector<std::string> warnings, errors;

  py::tuple as_python() const {
    py::list shown;
    for (const std::string& warning : warnings) shown.append(to_str(warning));
    const py::object text = is_done ? py::object(py::bytes(program)) : py::object(py::none());
    return py::make_tuple(text, py::bytes(report), waypoints.as_python(), shown);
  }
};

/// Runs `command`, which gets options, paths, console and what to do at the end.
template <typename Command>
py::tuple run(cli::Options options, bool causes, const Command& command) {
  Outcome outcome;
  {
    const py::gil_scoped_release released;
    options.json = true;
    options.without_causes = !causes;
    cli::Console console({.quiet = true},
                         {.error = [&](std::string_view text) { outcome.errors.emplace_back(text); },
                          .warning = [&](std::string_view text) { outcome.warnings.emplace_back(text); }});
    cli::OutputPaths paths;
    paths.take_program = [&](std::string_view text) { outcome.program += text; };
    paths.take_rows = [&](std::string_view rows) { outcome.waypoints.add(rows); };
    command(options, paths, console,
            [&](const cli::Run& finished, const cli::RunEnd& end, const cli::RunFiles&) {
              cli::print_warnings(finished, end.report, console);
              outcome.report = end.json;
              outcome.is_done = !end.report.error_kind;
              return end.report.error_kind;
            });
    if (outcome.report.empty()) {
      const std::string what = outcome.errors.empty() ? "the run has no result" : outcome.errors.front();
      const std::size_t at = what.find("error: ");
      throw InputError(ErrorKind::usage, {options.program},
                       at == std::string::npos ? what : what.substr(at + 7));
    }
  }
  return outcome.as_python();
}

py::tuple compensate(const LoadedMachine& machine, const std::string& text, const std::string& name,
                     const GivenOptions& given, bool causes) {
  return run(options_of(cli::Command::compensate, machine, name, given), causes,
             [&](const cli::Options& options, const cli::OutputPaths& paths, cli::Console& console,
                 const cli::ReportEnd& end) {
               compensate_run(options, *prepare_run(options, ready(options, machine), text, console), paths,
                              console, end);
             });
}

py::tuple predict(const LoadedMachine& machine, const std::string& text, const std::string& name,
                  const GivenOptions& given) {
  return run(options_of(cli::Command::predict, machine, name, given), true,
             [&](const cli::Options& options, const cli::OutputPaths& paths, cli::Console& console,
                 const cli::ReportEnd& end) {
               predict_run(options, *prepare_run(options, ready(options, machine), text, console), paths,
                           console, end);
             });
}

py::tuple verify(const LoadedMachine& machine, const std::string& text, const std::string& corrected,
                 const std::string& name, const GivenOptions& given) {
  cli::Options all = options_of(cli::Command::verify, machine, name, given);
  all.verify.corrected = name + " (corrected)";
  return run(std::move(all), true,
             [&](const cli::Options& options, const cli::OutputPaths& paths, cli::Console& console,
                 const cli::ReportEnd& end) {
               const auto prepared = prepare_run(options, ready(options, machine), text, console);
               verify_run(options, *prepared,
                          {{"corrected", options.verify.corrected, {}}, FileReader::of_bytes(corrected)},
                          paths, console, end);
             });
}

/// The machine, its text where that is known, the document of the report, and the covariance (SI).
py::tuple identify(const LoadedMachine& machine, const std::vector<std::string>& files,
                   const std::optional<std::string>& sets, const std::optional<std::string>& hold_out,
                   bool all, const std::string& prior, const GivenOptions& given) {
  cli::Options options = options_of(cli::Command::identify, machine, "", given);
  options.identify = {.data = files, .fit = sets, .hold_out = hold_out, .all = all, .prior = prior};
  Identification found;
  std::unique_ptr<LoadedMachine> identified;
  {
    const py::gil_scoped_release released;
    cli::Console console({.quiet = true});
    cli::refuse_wrong_values(options);
    const cli::MachineInput input = ready(options, machine);
    cli::identify_run(options, input, console, found);
    const std::string& path = machine.input.file.path;
    identified = machine.text.empty()
                     ? load(found.machine, machine.input.file, "")
                     : load_text(cli::identified_text(machine.text, path, found, files), path);
  }
  const py::object text =
      machine.text.empty() ? py::object(py::none()) : py::object(py::bytes(identified->text));
  return py::make_tuple(std::move(identified), text, py::bytes(to_json(found)));
}

std::vector<std::string> option_names() {
  std::vector<std::string> names;
  for (const cli::SettingOption& option : cli::setting_options()) names.emplace_back(option.option);
  return names;
}

}  // namespace

void define_runs(py::module_& module) {
  module.attr("option_names") = py::cast(option_names());
  module.def("compensate", compensate);
  module.def("predict", predict);
  module.def("verify", verify);
  module.def("identify", identify);
}

}  // namespace counterflex::python
