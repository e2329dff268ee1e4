#include "settings/command_options.hpp"

#include <CLI/CLI.hpp>
#include <functional>

#include "counterflex/machine/create.hpp"
#include "settings/help.hpp"
#include "settings/setting_options.hpp"
#include "settings/values.hpp"

namespace counterflex::cli {
namespace {

/// An option with one value that `take` makes sense of.
CLI::Option* value_option(CLI::App& app, const std::string& name, const std::string& type,
                          const std::string& help, std::function<void(const std::string&)> take) {
  CLI::Option* option = app.add_option_function<std::string>(name, std::move(take), help);
  return option->type_name(type)->take_last();
}

/// A flag of the table: its values are kept as they are, to be judged with those of other sources.
void add_setting(CLI::App& app, Options& options, std::string_view name, std::string_view other_help = {}) {
  const SettingOption& setting = setting_option(name);
  std::vector<Setting>& flags = options.sources.flags;
  const auto keep = [&flags, name](const std::vector<std::string>& values) {
    flags.push_back({std::string(name), values, {}, Origin::flag});
  };
  const std::string names(setting.flags), type(setting.type);
  const std::string help(other_help.empty() ? setting.help : other_help);
  CLI::Option* option = nullptr;
  if (type.empty())
    option = app.add_flag_function(
        names, [keep](std::int64_t count) { keep({count > 0 ? "true" : "false"}); }, help);
  else if (setting.repeated)
    option = app.add_option_function<std::vector<std::string>>(names, keep, help)
                 ->type_name(type)
                 ->allow_extra_args(false);
  else
    option = value_option(app, names, type, help, [keep](const std::string& value) { keep({value}); });
  option->group(std::string(setting.group));
}

void add_settings(CLI::App& app, Options& options, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) add_setting(app, options, name);
}

void add_forces(CLI::App& app, Options& options) {
  add_settings(app, options, {"forces", "force", "load-scale", "air-above"});
}

void add_reading(CLI::App& app, Options& options) {
  add_settings(app, options,
               {"dialect", "units", "integer-words", "arc-centres", "evaluate", "expand-subprograms", "data",
                "work", "tool-table", "tool-length"});
}

void add_config(CLI::App& app, Options& options) {
  value_option(app, "--config", "FILE",
               "The project file (default: counterflex.toml beside the program or above)",
               [&](const std::string& file) { options.sources.config = file; })
      ->group(std::string(group::settings));
  app.add_flag("--no-config", options.sources.no_config, "Ignore project files")
      ->group(std::string(group::settings));
  app.add_flag("--print-config", options.print_config,
               "Print the settings that apply and the origin of each, as a project file")
      ->group(std::string(group::settings));
}

void add_output(CLI::App& app, Options& options,
                std::string_view quiet = "Print no warnings and no progress") {
  const std::string output(group::output);
  app.add_flag("--json", options.json, "One JSON document on standard output and nothing else")
      ->group(output);
  app.add_flag("-q,--quiet", options.quiet, std::string(quiet))->group(output);
  app.add_flag("-v,--verbose", options.verbose, "Print all details")->group(output);
}

CLI::Option* add_file(CLI::App& app, const std::string& name, std::string& file, const std::string& help) {
  return app.add_option(name, file, help)->required()->type_name("");
}

void add_run(CLI::App& app, Options& options) {
  add_setting(app, options, "machine");
  add_forces(app, options);
  add_setting(app, options, "blend-mm");
  add_reading(app, options);
  add_settings(app, options,
               {"temperature-C", "method", "tolerance-mm", "tolerance-tilt-deg", "tolerance-spin-deg",
                "max-correction-mm", "accept-partial", "decimals", "uncertainty", "samples", "threads",
                "min-block-ms", "report", "plot", "force-overwrite"});
  add_config(app, options);
  add_output(app, options, "Print nothing but errors");
}

/// `examples`: lines of the help, which shows them after the usage line.
CLI::App& add_command(CLI::App& app, Options& options, const std::string& name, Command command,
                      const std::string& help, std::string_view examples) {
  CLI::App& subcommand = *app.add_subcommand(name, help);
  subcommand.footer(std::string(examples));
  subcommand.option_defaults()->group(std::string(group::common));
  subcommand.get_help_ptr()->group(std::string(group::output));
  subcommand.callback([&options, command] { options.command = command; });
  return subcommand;
}

void add_compensate(CLI::App& app, Options& options) {
  CLI::App& command =
      add_command(app, options, "compensate", Command::compensate, "Write the corrected program, verified",
                  "  counterflex compensate O1001.NC -m machine.toml --load-scale 0 --report O1001\n"
                  "  counterflex compensate O1001.NC -m machine.toml -f forces.csv -o corrected/\n"
                  "  counterflex compensate O1001.NC -m machine.toml --force=-120,0,-40");
  add_file(command, "PROGRAM", options.program, "The machining program; - is standard input");
  add_settings(command, options,
               {"output", "number-pieces", "max-points", "guard", "free", "only-significant", "proof"});
  add_run(command, options);
}

void add_predict(CLI::App& app, Options& options) {
  CLI::App& command =
      add_command(app, options, "predict", Command::predict,
                  "Show the deviation of a program and its causes; write no program",
                  "  counterflex predict O1001.NC -m machine.toml --load-scale 0\n"
                  "  counterflex predict O1001.NC -m machine.toml -f forces.csv --report O1001\n"
                  "  counterflex predict O1001.NC -m machine.toml -f forces.csv --offsets");
  add_file(command, "PROGRAM", options.program, "The machining program; - is standard input");
  command.add_flag("--offsets", options.predict.offsets,
                   "Find the work offsets, tool lengths and radii that leave the least deviation");
  add_setting(command, options, "free");
  add_run(command, options);
}

void add_verify(CLI::App& app, Options& options) {
  CLI::App& command =
      add_command(app, options, "verify", Command::verify, "Check a corrected program against its original",
                  "  counterflex verify O1001.NC O1001.comp.NC -m machine.toml -f forces.csv");
  add_file(command, "ORIGINAL", options.program, "The original program");
  add_file(command, "CORRECTED", options.verify.corrected, "The corrected program");
  add_settings(command, options, {"only-significant", "proof"});
  add_run(command, options);
}

void add_compare(CLI::App& app, Options& options) {
  CLI::App& command = add_command(app, options, "compare", Command::compare,
                                  "Show the reports of two runs side by side: machines, methods, tolerances",
                                  "  counterflex compare before.json after.json --report comparison");
  command
      .add_option("REPORT", options.compare.reports,
                  "Two reports, STEM.json or STEM.html, as --report wrote them")
      ->required()
      ->expected(2)
      ->type_name("");
  command
      .add_option("--name", options.compare.names,
                  "The name of a run; given twice, in the order of the reports")
      ->type_name("NAME")
      ->allow_extra_args(false);
  value_option(command, "--report", "STEM", "Write STEM.json and STEM.html, a page of both runs",
               [&](const std::string& text) { options.report = text; });
  add_setting(command, options, "force-overwrite");
  add_output(command, options);
}

void add_analyze(CLI::App& app, Options& options) {
  CLI::App& command = add_command(app, options, "analyze", Command::analyze,
                                  "Stiffness, assembly, joint loads, deviation and corrected target at poses",
                                  "  counterflex analyze -m machine.toml --at 0,0,-100 --force 0,0,-200\n"
                                  "  counterflex analyze -m machine.toml --at 0,0,-100 --full\n"
                                  "  counterflex analyze -m robot.toml --joints 0,-90,90,0,45,0");
  add_setting(command, options, "machine");
  command
      .add_option("--at", options.analyze.at,
                  "A pose of the tip: mm, and roll, pitch, yaw in degrees; may be repeated")
      ->type_name("X,Y,Z[,R,P,Y]")
      ->allow_extra_args(false);
  command
      .add_option("--joints", options.analyze.joints,
                  "Instead of --at: actuator values as the control shows them, mm or degrees; prints the tip")
      ->type_name("J1,J2,...")
      ->allow_extra_args(false);
  command
      .add_option("--pose", options.analyze.poses,
                  "Instead of --at: a pose of the tip as the control shows it; prints the actuator values")
      ->type_name("X,Y,Z,A,B,C")
      ->allow_extra_args(false);
  value_option(command, "--as", "kuka|fanuc|abb|ur",
               "How --pose is written (default: fanuc): A B C, W P R, q1 to q4 or a rotation vector in rad",
               [&](const std::string& text) { options.analyze.as = text; });
  value_option(command, "--tool", "T3",
               "The tool of the machine file in the spindle (default: [tool], rigid)",
               [&](const std::string& text) { options.analyze.tool = text; });
  value_option(command, "--force", "FX,FY,FZ[,MX,MY,MZ]",
               "A wrench on the tool at its tip: N and N m, machine frame",
               [&](const std::string& text) { options.analyze.force = parse_force(text); });
  add_setting(command, options, "method");
  command.add_flag("--full", options.analyze.full,
                   "Every chain in detail: stiffness, energy, each joint and spring by name");
  value_option(command, "--hold", "X,Y,Z[,R,P,Y]",
               "The wrenches that hold the tip at this pose while the actuators are commanded for --at",
               [&](const std::string& text) { options.analyze.hold = text; });
  value_option(command, "--curve", "DIRECTION=FROM:TO:STEPS",
               "Force over displacement of the tip, mm, along x, y, z or a vector 1,0,1; the critical load",
               [&](const std::string& text) { options.analyze.curve = text; });
  value_option(command, "-o,--output", "OUTPUT", "Write the points of --curve as a table (.csv)",
               [&](const std::string& text) { options.output = text; });
  add_setting(command, options, "force-overwrite");
  add_config(command, options);
  add_output(command, options);
}

void add_map(CLI::App& app, Options& options) {
  CLI::App& command =
      add_command(app, options, "map", Command::map,
                  "Stiffness or deviation over the workspace: the best place for a part",
                  "  counterflex map -m machine.toml --plot map.svg\n"
                  "  counterflex map -m machine.toml --deviation --force=-150,80,-60 -o map.csv\n"
                  "  counterflex map O1001.NC -m machine.toml --box 0,0,-400,600,400,-100 --grid 31,21,4");
  command.add_option("PROGRAM", options.program, "A program to find the best place for; may be left out")
      ->type_name("");
  add_setting(command, options, "machine");
  MapOptions& map = options.map;
  const auto text = [&](const std::string& name, const std::string& type, const std::string& help,
                        std::optional<std::string>& value) {
    value_option(command, name, type, help, [&value](const std::string& given) { value = given; });
  };
  command.add_flag("--stiffness", map.stiffness,
                   "The least stiffness of the tip and its direction (default)");
  command.add_flag("--deviation", map.deviation,
                   "Instead: the deviation of the tip with errors, weight and --force");
  text("--direction", "DIRECTION", "The stiffness along x, y, z or a vector 1,0,1, instead of the least",
       map.direction);
  value_option(command, "--force", "FX,FY,FZ[,MX,MY,MZ]",
               "A wrench on the tool at its tip: N and N m, machine frame",
               [&map](const std::string& given) { map.force = parse_force(given); });
  text("--box", "X0,Y0,Z0,X1,Y1,Z1",
       "Corners of the mapped box in mm, machine frame (default: what the machine reaches)", map.box);
  text("--grid", "NX,NY,NZ", "Places along x, y and z (default 21,21,3)", map.grid);
  text("--rpy", "R,P,Y",
       "Turns the orientation of home by roll, pitch, yaw in degrees, about the axes of the machine frame",
       map.rpy);
  text("--tool", "T3", "The tool of the machine file in the spindle (default: [tool], rigid)", map.tool);
  value_option(command, "-o,--output", "OUTPUT", "Write all places as a table (.csv); -: to standard output",
               [&](const std::string& output) { options.output = output; });
  text("--plot", "FILE.svg", "Write a picture, one panel for each z", map.plot);
  add_settings(command, options, {"threads", "force-overwrite"});
  add_reading(command, options);
  add_config(command, options);
  add_output(command, options);
}

void add_show_forces(CLI::App& app, Options& options) {
  CLI::App& command = add_command(app, options, "forces", Command::forces,
                                  "Show the wrench of every feed move, or write it as a force profile",
                                  "  counterflex forces O1001.NC -f cutting.toml -m machine.toml\n"
                                  "  counterflex forces O1001.NC -f cutting.toml -o profile.csv\n"
                                  "  counterflex forces --materials\n"
                                  "  counterflex forces fit O1001.NC -f cutting.toml --log power.csv -o "
                                  "fitted.toml");
  command.add_option("PROGRAM", options.program, "The machining program; - is standard input")->type_name("");
  add_setting(command, options, "machine",
              "The machine on which the program runs (without it the tool is along z of the program)");
  value_option(command, "-o,--output", "OUTPUT",
               "Write a force profile (.csv), or the fitted cutting model (.toml); -: to standard output, "
               "instead of the table",
               [&](const std::string& text) { options.output = text; });
  add_setting(command, options, "force-overwrite");
  command.add_flag("--materials", options.forces_table.materials,
                   "List the built-in cutting coefficients with their sources");
  command.add_flag("--fit", options.forces_table.fit,
                   "Identify the coefficients of the cutting model from --log; also written as forces fit");
  value_option(command, "--log", "LOG", "Of --fit: spindle power or torque over time or by line (.csv)",
               [&](const std::string& text) { options.forces_table.log = text; });
  add_forces(command, options);
  add_reading(command, options);
  add_config(command, options);
  add_output(command, options);
}

void add_check(CLI::App& app, Options& options) {
  CLI::App& command =
      add_command(app, options, "check", Command::check,
                  "Read machine files (.toml) and programs, show what was understood, find mistakes",
                  "  counterflex check O1001.NC\n"
                  "  counterflex check machine.toml\n"
                  "  counterflex check O1001.NC -m machine.toml\n"
                  "  counterflex check machine.toml --draw machine.svg");
  command.add_option("FILE", options.check.files, "Machine files and programs")->required()->type_name("");
  command.add_flag("--parameters", options.check.parameters,
                   "List the numbers of machine files that measurements can identify: value, sigma, source");
  value_option(command, "--draw", "FILE.svg",
               "Draw the machine of the only machine file, at home, in three views",
               [&](const std::string& file) { options.check.draw = file; });
  add_setting(command, options, "force-overwrite");
  add_setting(command, options, "machine",
              "The machine on which the programs run: is every point in its travel?");
  add_reading(command, options);
  add_config(command, options);
  add_output(command, options);
}

void add_new(CLI::App& app, Options& options) {
  CLI::App& command = add_command(
      app, options, "new", Command::create, "Write a machine file from what a shop knows of a machine",
      "  counterflex new mill3 --travel X=762,Y=406,Z=508 --tip-stiffness-N-per-um 28,22,45 -o mill.toml\n"
      "  counterflex new robot6r --robot kuka-kr270-r2700-ultra -o robot.toml\n"
      "  counterflex new --robots");
  NewOptions& facts = options.create;
  std::string kinds;
  for (const KindOfMachine& kind : kinds_of_machine)
    kinds += (kinds.empty() ? "" : ", ") + std::string(kind.name);
  command.add_option("KIND", facts.kind, kinds)->type_name("");
  const auto text = [&](const std::string& name, const std::string& type, const std::string& help,
                        std::optional<std::string>& value) {
    value_option(command, name, type, help, [&value](const std::string& given) { value = given; });
  };
  value_option(command, "--name", "NAME", "The name of the machine",
               [&facts](const std::string& name) { facts.name = name; });
  text("--travel", "X=762,Y=406,Z=508",
       "Travel of axes in mm or degrees, or X=-762:0; L is a leg or a carriage, from home", facts.travel);
  text("--squareness-um-per-m", "XY=-18,YZ=12,ZX=-25",
       "Squareness of a mill: positive if the angle between the axes is above 90 degrees", facts.squareness);
  text("--tip-stiffness-N-per-um", "KX,KY,KZ", "Stiffness of a mill at the tool tip along x, y, z",
       facts.tip_stiffness);
  text("--pivot-mm", "X,Y,Z", "Where the rotary axes of a table cross, in machine coordinates", facts.pivot);
  text("--robot", "NAME", "The robot of robot6r, of the list of --robots", facts.robot);
  command.add_flag("--robots", facts.robots,
                   "List the robots that are known, with the sources of their data");
  text("--nodes", "FILE", "The joints of a hexapod's legs (.csv): base in M, platform in P", facts.nodes);
  text("--home-mm", "X,Y,Z", "Place of a hexapod's platform in M at home", facts.home);
  text("--leg-stiffness-N-per-um", "K",
       "Stiffness of a leg of a hexapod, or of a drive of a delta or orthoglide", facts.leg_stiffness);
  text("--arm-mm", "LENGTH", "Length of the bars of a delta or orthoglide", facts.arm);
  text("--radius-mm", "LENGTH", "Horizontal length of the bars of a delta with its platform in the centre",
       facts.radius);
  value_option(command, "-o,--output", "OUTPUT", "The machine file (default: standard output)",
               [&](const std::string& output) { options.output = output; });
  add_setting(command, options, "force-overwrite");
  command.add_flag("-q,--quiet", options.quiet, "Print only errors")->group(std::string(group::output));
}

void add_identify(CLI::App& app, Options& options) {
  CLI::App& command = add_command(app, options, "identify", Command::identify,
                                  "Find errors and compliances of a machine from measurements",
                                  "  counterflex identify -m robot.toml --data tracker.csv -o measured.toml\n"
                                  "  counterflex identify -m mill.toml --data pushes.csv --fit compliance");
  add_setting(command, options, "machine");
  command
      .add_option("--data", options.identify.data,
                  "Measurements: CSV, or a description (.toml); may be repeated")
      ->required()
      ->type_name("FILE")
      ->allow_extra_args(false);
  value_option(command, "--fit", "LIST",
               "What is fitted: zeros, geometry, compliance, mass, reversal, tables, harmonics (default: all "
               "but mass; "
               "compliance if the rows are pushes and weights)",
               [&](const std::string& text) { options.identify.fit = text; });
  value_option(
      command, "--hold-out", "session|region|20%",
      "Which rows test fits that are made without them (default: sessions if there are several, else 20%)",
      [&](const std::string& text) { options.identify.hold_out = text; });
  value_option(command, "--prior", "STEM.json",
               "The covariance of the fit that wrote the machine file, as its --report gave it",
               [&](const std::string& text) { options.identify.prior = text; });
  command.add_flag("--all", options.identify.all, "Keep what does not improve the rows held out, too");
  value_option(command, "--for", "PROGRAM",
               "Name the three next measurements that make the deviations of this program more certain",
               [&](const std::string& text) { options.identify.program = text; });
  value_option(command, "-o,--output", "OUTPUT", "Write the machine file with the identified values (.toml)",
               [&](const std::string& text) { options.output = text; });
  value_option(command, "--report", "STEM",
               "Write STEM.json, all values with their covariance, and STEM.html, a page",
               [&](const std::string& text) { options.report = text; });
  add_forces(command, options);
  add_settings(command, options,
               {"blend-mm", "dialect", "units", "integer-words", "arc-centres", "evaluate",
                "expand-subprograms", "work", "tool-table", "tool-length", "threads", "force-overwrite"});
  add_config(command, options);
  add_output(command, options);
}

void add_testcut(CLI::App& app, Options& options) {
  CLI::App& command = add_command(
      app, options, "testcut", Command::testcut,
      "Write a program of a test piece, half of it corrected, and a sheet for what is measured on it",
      "  counterflex testcut -m mill.toml --box 0,0,-5,240,150,0 --tool T1 --diameter-mm 10 \\\n"
      "      -f cutting.toml -o coupon.ngc --sheet coupon.csv\n"
      "  counterflex identify -m mill.toml --data coupon.csv -o measured.toml");
  add_setting(command, options, "machine");
  TestcutOptions& testcut = options.testcut;
  const auto text = [&](const std::string& name, const std::string& type, const std::string& help,
                        std::optional<std::string>& value) {
    return value_option(command, name, type, help, [&value](const std::string& given) { value = given; });
  };
  text("--box", "X0,Y0,Z0,X1,Y1,Z1",
       "Corners of the cut box in mm, program coordinates of G54: Z1 is the top of the stock", testcut.box)
      ->required();
  text("--tool", "T3", "The number of the end mill", testcut.tool)->required();
  text("--diameter-mm", "LENGTH", "Its diameter (default: of [tools] in the machine file)", testcut.diameter);
  text("--feed-mm-min", "FEED", "Feed (default: 0.05 mm for a tool of 10 mm and each of two teeth)",
       testcut.feed);
  text("--speed-rpm", "SPEED", "Speed of the spindle (default: 60 m/min)", testcut.speed);
  value_option(command, "-o,--output", "OUTPUT", "The program (LinuxCNC)", [&](const std::string& output) {
    options.output = output;
  })->required();
  text("--sheet", "FILE", "The sheet for measured values (.csv)", testcut.sheet)->required();
  add_forces(command, options);
  add_settings(command, options,
               {"blend-mm", "work", "tolerance-mm", "max-correction-mm", "threads", "force-overwrite"});
  add_config(command, options);
  command.add_flag("-q,--quiet", options.quiet, "Print only errors")->group(std::string(group::output));
}

void add_import(CLI::App& app, Options& options) {
  CLI::App& command = add_command(
      app, options, "import", Command::import, "Write a machine file from another description of the machine",
      "  counterflex import urdf robot.urdf --base base_link --tip tool0 -o machine.toml\n"
      "  counterflex import dh arm.csv --convention standard -o machine.toml\n"
      "  counterflex import ur-calibration calibration.yaml -o machine.toml\n"
      "  counterflex import linuxcnc hexapod.ini -o machine.toml\n"
      "  counterflex import volcomp mill.csv --format isg -o tables.toml");
  add_file(command, "SOURCE", options.import.source,
           "What FILE is: urdf, dh, ur-calibration, linuxcnc or volcomp");
  add_file(
      command, "FILE", options.import.file,
      "A URDF, a table of DH parameters (.csv), a calibration of a UR arm (.yaml), a HAL or INI file, or a "
      "file of volumetric compensation");
  value_option(command, "--base", "LINK", "Of a URDF: the link that is the machine frame (default: the root)",
               [&](const std::string& text) { options.import.base = text; });
  value_option(command, "--tip", "LINK", "Of a URDF: the link that is the platform (default: the only end)",
               [&](const std::string& text) { options.import.tip = text; });
  value_option(command, "--convention", "standard|modified", "Of a DH table",
               [&](const std::string& text) { options.import.convention = text; });
  value_option(command, "--format", "isg|etalon", "Of a file of volumetric compensation",
               [&](const std::string& text) { options.import.format = text; });
  command.add_flag("--negate", options.import.negate,
                   "The file of volumetric compensation has what the control adds, not the errors");
  value_option(command, "-o,--output", "OUTPUT", "The machine file (default: standard output)",
               [&](const std::string& text) { options.output = text; });
  add_setting(command, options, "force-overwrite");
  command.add_flag("-q,--quiet", options.quiet, "Print nothing but errors")
      ->group(std::string(group::output));
}

void add_batch(CLI::App& app, Options& options) {
  CLI::App& command = add_command(app, options, "batch", Command::batch,
                                  "Correct all programs of a list of jobs and write a summary",
                                  "  counterflex batch jobs.toml\n"
                                  "  counterflex batch jobs.toml --resume");
  add_file(command, "JOBS", options.batch.jobs, "The jobs file (.toml)");
  command.add_flag("--resume", options.batch.resume,
                   "Skip jobs whose options, inputs and outputs have not changed since the last run");
  value_option(command, "--shard", "I/N",
               "Run the jobs of shard I of N; other processes or computers run the others",
               [&](const std::string& text) { options.batch.shard = read_shard(text); });
  command.add_flag("--merge", options.batch.merge, "Write the summary of all shards");
  command.add_flag("--estimate", options.batch.estimate,
                   "Print how long the jobs would take on one processor, by trying some of them");
  add_setting(command, options, "threads", "Processors; the output does not depend on it (default: all)");
  add_setting(command, options, "force-overwrite");
  add_output(command, options);
}

void add_watch(CLI::App& app, Options& options) {
  CLI::App& command = add_command(app, options, "watch", Command::watch,
                                  "Correct the programs that a post-processor writes into a folder",
                                  "  counterflex watch posted/ -m machine.toml -o corrected/\n"
                                  "  counterflex watch posted/ -m machine.toml --once");
  add_file(command, "DIR", options.watch.folder, "The folder");
  command
      .add_option("--pattern", options.watch.patterns,
                  "Only files whose names match, as in a shell (default: all programs); may be repeated")
      ->type_name("'*.ngc'")
      ->allow_extra_args(false);
  command.add_flag("--once", options.watch.once, "Process the programs that are not yet done, then end");
  add_setting(
      command, options, "output",
      "The folder of the corrected programs, or a pattern (default: NAME.comp.EXT beside each program)");
  add_settings(command, options, {"number-pieces", "max-points", "guard", "only-significant", "proof"});
  add_run(command, options);
}

}  // namespace

void add_commands(CLI::App& app, Options& options) {
  add_compensate(app, options);
  add_predict(app, options);
  add_verify(app, options);
  add_compare(app, options);
  add_analyze(app, options);
  add_map(app, options);
  add_show_forces(app, options);
  add_check(app, options);
  add_new(app, options);
  add_identify(app, options);
  add_testcut(app, options);
  add_import(app, options);
  add_batch(app, options);
  add_watch(app, options);
}

}  // namespace counterflex::cli
