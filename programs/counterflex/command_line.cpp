#include "command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <thread>

#include "counterflex/geometry/units.hpp"
#include "values.hpp"
#include "version.hpp"

namespace counterflex::cli {
namespace {

/// An option with one value that `take` makes sense of.
CLI::Option* value_option(CLI::App& app, const std::string& name, const std::string& type,
                          const std::string& help, std::function<void(const std::string&)> take) {
  CLI::Option* option = app.add_option_function<std::string>(name, std::move(take), help);
  return option->type_name(type)->take_last();
}

/// Without the list that the library would add to the help.
CLI::Validator one_of(std::vector<std::string> allowed) {
  return CLI::IsMember(std::move(allowed)).description("");
}

void add_inputs(CLI::App& app, Options& options) {
  app.add_option("-m,--machine", options.machine, "The machine file")->type_name("MACHINE")->required();
}

void add_force(CLI::App& app, Options& options) {
  value_option(app, "--force", "FX,FY,FZ[,MX,MY,MZ]",
               "A constant wrench on the tool at its tip in feed moves: N and N m, machine frame",
               [&](const std::string& text) { options.force = parse_force(text); });
}

void add_forces(CLI::App& app, Options& options) {
  app.add_option("-f,--forces", options.forces,
                 "Forces by place, tool or operation (.csv), cutting models (.toml); may be repeated")
      ->type_name("FORCES")
      ->allow_extra_args(false);
  app.add_option_function<std::vector<std::string>>(
         "--force",
         [&](const std::vector<std::string>& texts) {
           for (const std::string& text : texts) options.force_rules.push_back(parse_force_rule(text));
         },
         "A constant wrench on the tool at its tip in feed moves, or in those of a tool: N and N m, machine "
         "frame; may be repeated")
      ->type_name("[T3=]FX,FY,FZ[,MX,MY,MZ]")
      ->allow_extra_args(false);
  value_option(app, "--load-scale", "SCALE", "Multiplies all cutting forces [1]; 0 corrects geometry only",
               [&](const std::string& text) { options.load_scale = number_of("--load-scale", text, {0}); });
  value_option(app, "--air-above", "Z", "Feed moves wholly above this Z of the program carry no force, mm",
               [&](const std::string& text) { options.air_above_mm = number_of("--air-above", text); });
}

void add_blend(CLI::App& app, Options& options) {
  value_option(app, "--blend-mm", "LENGTH",
               "A step of the force acts as a ramp over this length [2]; 0: as a jump",
               [&](const std::string& text) { options.blend = number_of("--blend-mm", text, {0}) * mm; });
}

void add_reading(CLI::App& app, Options& options) {
  value_option(app, "--dialect", "NAME",
               "auto, linuxcnc, grbl, fanuc, haas, mach3, siemens or heidenhain; the machine file's, or auto",
               [&](const std::string& text) { options.dialect = text; });
  value_option(app, "--units", "mm|inch", "Units before the program states its own",
               [&](const std::string& text) {
                 options.units = text == "mm" ? LengthUnit::millimetres : LengthUnit::inches;
               })
      ->check(one_of({"mm", "inch"}));
  value_option(app, "--integer-words", "units|increments",
               "What length words without a point mean to a fanuc or haas control",
               [&](const std::string& text) {
                 options.integer_words = text == "units" ? IntegerWords::units : IntegerWords::increments;
               })
      ->check(one_of({"units", "increments"}));
  app.add_flag("--expand-subprograms", options.expand_subprograms,
               "Put the bodies of subprograms in the place of calls with plain numbers");
  app.add_option("--work", options.work,
                 "A work offset in the machine frame, mm and degrees; may be repeated")
      ->type_name("G54=X,Y,Z[,RX,RY,RZ]")
      ->allow_extra_args(false);
  value_option(app, "--tool-table", "FILE", "Tool lengths as LinuxCNC keeps them, mm",
               [&](const std::string& text) { options.tool_table = text; });
}

void add_method(CLI::App& app, Options& options) {
  value_option(app, "--method", "NAME", "How targets are solved: direct, nested or linear [direct]",
               [&](const std::string& text) {
                 options.method = text == "nested"   ? Method::nested
                                  : text == "linear" ? Method::linear
                                                     : Method::direct;
               })
      ->check(one_of({"direct", "nested", "linear"}));
}

void add_correction(CLI::App& app, Options& options) {
  add_method(app, options);
  value_option(app, "--tolerance-mm", "LENGTH", "The largest deviation of the tip to leave [0.005]",
               [&](const std::string& text) {
                 options.tolerance = number_of("--tolerance-mm", text, {0, true}) * mm;
               });
  value_option(app, "--max-correction-mm", "LENGTH",
               "The largest correction to accept; the machine file's limit, or 1",
               [&](const std::string& text) {
                 options.max_correction = number_of("--max-correction-mm", text, {0, true}) * mm;
               });
  value_option(app, "--decimals", "N", "Digits after the point in corrected words; each word's own",
               [&](const std::string& text) { options.decimals = integer_of("--decimals", text, 0, 9); });
  value_option(app, "--threads", "N", "Threads to use; the result does not depend on it; one a processor",
               [&](const std::string& text) { options.threads = integer_of("--threads", text, 1, 1024); });
}

void add_output(CLI::App& app, Options& options) {
  app.add_flag("--json", options.json, "One JSON document on standard output and nothing else");
  app.add_flag("-q,--quiet", options.quiet, "Errors only on standard error");
  app.add_flag("-v,--verbose", options.verbose, "More about what is done");
}

void add_report(CLI::App& app, Options& options) {
  value_option(
      app, "--min-block-ms", "TIME", "Feed moves that take less are warned of [2]",
      [&](const std::string& text) { options.min_block_ms = number_of("--min-block-ms", text, {0}); });
  value_option(app, "--report", "STEM", "Write STEM.html, STEM.json and STEM.csv",
               [&](const std::string& text) { options.report = text; });
  value_option(app, "--plot", "FILE.svg", "Write the deviation along the path and its causes as a picture",
               [&](const std::string& text) { options.plot = text; });
}

CLI::Option* add_file(CLI::App& app, const std::string& name, std::string& file, const std::string& help) {
  return app.add_option(name, file, help)->required()->type_name("");
}

void add_run(CLI::App& app, Options& options) {
  add_inputs(app, options);
  add_forces(app, options);
  add_blend(app, options);
  add_reading(app, options);
  add_correction(app, options);
  add_report(app, options);
  add_output(app, options);
}

CLI::App& add_command(CLI::App& app, Options& options, const std::string& name, Command command,
                      const std::string& help) {
  CLI::App& subcommand = *app.add_subcommand(name, help);
  subcommand.callback([&options, command] { options.command = command; });
  return subcommand;
}

void add_compensate(CLI::App& app, Options& options) {
  CLI::App& command = add_command(app, options, "compensate", Command::compensate,
                                  "Write the program whose execution follows the path of the original");
  add_file(command, "PROGRAM", options.program, "The machining program; - is standard input");
  value_option(command, "-o,--output", "OUTPUT",
               "The corrected program; NAME.comp.EXT beside the input; - is standard "
               "output",
               [&](const std::string& text) { options.output = text; });
  add_run(command, options);
}

void add_predict(CLI::App& app, Options& options) {
  CLI::App& command = add_command(app, options, "predict", Command::predict,
                                  "Show the deviation of a program and what causes it; write no program");
  add_file(command, "PROGRAM", options.program, "The machining program; - is standard input");
  add_run(command, options);
}

void add_verify(CLI::App& app, Options& options) {
  CLI::App& command = add_command(app, options, "verify", Command::verify,
                                  "Solve a corrected program forward against the path of the original");
  add_file(command, "ORIGINAL", options.program, "The program that says what is wanted");
  add_file(command, "CORRECTED", options.corrected, "The program that is to be judged");
  add_run(command, options);
}

void add_compare(CLI::App& app, Options& options) {
  CLI::App& command = add_command(app, options, "compare", Command::compare,
                                  "Show the reports of two runs side by side: machines, methods, tolerances");
  command
      .add_option("REPORT", options.reports, "Two reports, STEM.json or STEM.html, as --report wrote them")
      ->required()
      ->expected(2)
      ->type_name("");
  command
      .add_option("--name", options.names, "What a run is called; given twice, in the order of the reports")
      ->type_name("NAME")
      ->allow_extra_args(false);
  value_option(command, "--report", "STEM", "Write STEM.json and STEM.html, a page of both runs",
               [&](const std::string& text) { options.report = text; });
  add_output(command, options);
}

void add_analyze(CLI::App& app, Options& options) {
  CLI::App& command =
      add_command(app, options, "analyze", Command::analyze,
                  "Stiffness, assembly, joint loads, deviation and corrected target at poses");
  add_inputs(command, options);
  command
      .add_option("--at", options.at,
                  "A pose of the tip: mm, and roll, pitch, yaw in degrees; may be repeated")
      ->type_name("X,Y,Z[,R,P,Y]")
      ->allow_extra_args(false)
      ->required();
  value_option(command, "--tool", "T3", "The tool of the machine file in the spindle; [tool], rigid",
               [&](const std::string& text) { options.tool = text; });
  add_force(command, options);
  add_method(command, options);
  add_output(command, options);
}

void add_show_forces(CLI::App& app, Options& options) {
  CLI::App& command = add_command(app, options, "forces", Command::forces,
                                  "Show the wrench of every feed move, or write it as a force profile");
  command.add_option("PROGRAM", options.program, "The machining program; - is standard input")->type_name("");
  command
      .add_option("-m,--machine", options.machine,
                  "The machine on which the program runs; the tool stands along z of the program without one")
      ->type_name("MACHINE");
  value_option(command, "-o,--output", "OUTPUT", "A force profile (.csv) to write; - takes the table's place",
               [&](const std::string& text) { options.output = text; });
  command.add_flag("--materials", options.materials,
                   "List the cutting coefficients that a cutting model can name, with their sources");
  add_forces(command, options);
  add_reading(command, options);
  add_output(command, options);
}

void add_check(CLI::App& app, Options& options) {
  CLI::App& command =
      add_command(app, options, "check", Command::check,
                  "Read machine files (.toml) and programs, say what was understood, find mistakes");
  command.add_option("FILE", options.files, "Machine files and programs")->required()->type_name("");
  command.add_option("-m,--machine", options.machine, "A machine that is to reach the programs' points")
      ->type_name("MACHINE");
  add_reading(command, options);
  add_output(command, options);
}

void add_watch(CLI::App& app, Options& options) {
  CLI::App& command = add_command(app, options, "watch", Command::watch,
                                  "Compensate the programs that a post-processor drops into a folder");
  add_file(command, "DIR", options.folder, "The folder");
  value_option(command, "-o,--output", "DIR",
               "The folder of the corrected programs; NAME.comp.EXT beside each program",
               [&](const std::string& text) { options.output = text; });
  command
      .add_option("--pattern", options.patterns,
                  "Only files whose names match, as in a shell; all programs; may be repeated")
      ->type_name("'*.ngc'")
      ->allow_extra_args(false);
  command.add_flag("--once", options.once, "Do what is there and not yet done, and end");
  add_run(command, options);
}

void describe_program(CLI::App& app) {
  app.description(
      "Bends a machining program against the errors and the deflection of its machine, and reports the "
      "deviation\n"
      "before and after.");
  app.footer(
      "Exit status: 0 done, 1 internal error, 2 usage, 3 program text, 4 machine or force file, 5 tolerance "
      "missed or\n"
      "not converged, 6 travel or correction limit, 75 input or output failed, 130 interrupted (143 by "
      "SIGTERM).");
  app.set_version_flag("--version", fmt::format("counterflex {}", version), "Print the version");
  app.require_subcommand(1);
  app.get_formatter()->column_width(38);
}

/// A value that begins with a minus, joined with the option before it: "--at -10,0,0" reads as
/// "--at=-10,0,0".
std::vector<std::string> joined(int argc, const char* const* argv) {
  std::vector<std::string> words;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    const bool negative =
        word.size() > 1 && word[0] == '-' && (word[1] == '.' || (word[1] >= '0' && word[1] <= '9'));
    const bool takes_numbers =
        !words.empty() && words.back().starts_with("--") && words.back().find('=') == std::string::npos;
    if (negative && takes_numbers)
      words.back().append("=").append(word);
    else
      words.emplace_back(word);
  }
  return words;
}

Exit leave(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success))
    return static_cast<Exit>(app.exit(error));
  const auto chosen = app.get_subcommands();
  fmt::print(stderr, "error: {}\nSee counterflex {}--help.\n", error.what(),
             chosen.empty() ? "" : chosen.front()->get_name() + " ");
  return Exit::usage;
}

}  // namespace

std::variant<Options, Exit> read_command_line(int argc, const char* const* argv) {
  Options options;
  options.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  CLI::App app("", "counterflex");
  describe_program(app);
  add_compensate(app, options);
  add_predict(app, options);
  add_verify(app, options);
  add_compare(app, options);
  add_analyze(app, options);
  add_show_forces(app, options);
  add_check(app, options);
  add_watch(app, options);
  try {
    auto words = joined(argc, argv);
    std::reverse(words.begin(), words.end());
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    return leave(app, error);
  }
  return options;
}

}  // namespace counterflex::cli
