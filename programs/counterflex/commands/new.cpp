#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "commands/commands.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/machine/create.hpp"
#include "counterflex/machine/parameters.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "counterflex/statics/nominal.hpp"
#include "process/read_input.hpp"
#include "process/standard_output.hpp"
#include "run/command_outputs.hpp"
#include "run/inputs.hpp"
#include "run/run_files.hpp"
#include "settings/values.hpp"

namespace counterflex::cli {
namespace {

constexpr std::string_view travel_flag = "--travel", squareness_flag = "--squareness-um-per-m",
                           tip_flag = "--tip-stiffness-N-per-um", pivot_flag = "--pivot-mm",
                           robot_flag = "--robot", nodes_flag = "--nodes", home_flag = "--home-mm",
                           leg_flag = "--leg-stiffness-N-per-um", arm_flag = "--arm-mm",
                           radius_flag = "--radius-mm";

[[noreturn]] void refuse_flags(const std::string& message) {
  throw InputError(ErrorKind::usage, {}, message);
}

std::string robots_text() {
  std::string text;
  for (const KnownRobot& robot : known_robots()) {
    text += fmt::format("{}{}\n  {}\n  lengths    {}\n", text.empty() ? "" : "\n", robot.name, robot.title,
                        robot.lengths);
    text += fmt::format("  stiffness  {}\n",
                        robot.stiffness.empty() ? "not published: a prior by payload" : robot.stiffness);
    text += fmt::format("  masses     {}\n", robot.masses.empty() ? "not published: left out" : robot.masses);
  }
  return text;
}

const KindOfMachine& kind_of(const std::string& name) {
  std::vector<std::string_view> names;
  for (const KindOfMachine& kind : kinds_of_machine) names.push_back(kind.name);
  if (name.empty()) refuse_flags(fmt::format("new needs a KIND, one of {}", fmt::join(names, ", ")));
  return kinds_of_machine[choice_of("KIND", name, names)];
}

/// "NAME=VALUE" of a list, in its order.
std::vector<std::pair<std::string_view, std::string_view>> entries_of(std::string_view flag,
                                                                      std::string_view text,
                                                                      std::string_view form) {
  std::vector<std::pair<std::string_view, std::string_view>> entries;
  for (bool more = true; more;) {
    const std::size_t comma = text.find(',');
    const std::string_view entry = text.substr(0, comma);
    const std::size_t equals = entry.find('=');
    if (equals == 0 || equals == std::string_view::npos)
      refuse_flags(fmt::format("{}: '{}' must be as {}", flag, entry, form));
    for (const auto& [name, value] : entries)
      if (name == entry.substr(0, equals)) refuse_flags(fmt::format("{} has {} twice", flag, name));
    entries.emplace_back(entry.substr(0, equals), entry.substr(equals + 1));
    more = comma != std::string_view::npos;
    if (more) text.remove_prefix(comma + 1);
  }
  return entries;
}

/// The range of an axis; of a single number the usual one: from zero up, of Z down, of L around home.
AxisRange range_of(char axis, std::string_view text) {
  const std::string label = fmt::format("{} {}", travel_flag, axis);
  const std::size_t colon = text.find(':');
  if (colon != std::string_view::npos) {
    const AxisRange range{number_of(label, text.substr(0, colon)), number_of(label, text.substr(colon + 1))};
    if (range.min < range.max) return range;
    refuse_flags(fmt::format("{} is '{}': the first value must be below the second", label, text));
  }
  if (axis == 'A' || axis == 'B' || axis == 'C')
    refuse_flags(fmt::format("{} is '{}', must be a range in degrees, as {}=-120:30", label, text, axis));
  const double length = number_of(label, text, {0, true});
  return axis == 'Z'   ? AxisRange{-length, 0}
         : axis == 'L' ? AxisRange{-length / 2, length / 2}
                       : AxisRange{0, length};
}

std::map<char, AxisRange> travel_of(const std::string& text, const KindOfMachine& kind) {
  std::map<char, AxisRange> travel;
  for (const auto& [name, value] : entries_of(travel_flag, text, "X=762 or X=-762:0")) {
    if (name.size() != 1 || kind.travel.find(name[0]) == std::string_view::npos)
      refuse_flags(fmt::format("{}: a {} has no axis {}; it has {}", travel_flag, kind.name, name,
                               fmt::join(kind.travel, ", ")));
    const AxisRange range = range_of(name[0], value);
    const bool rotary = name[0] <= 'C';
    if ((rotary || name[0] == 'L') && !(range.min <= 0 && range.max >= 0))
      refuse_flags(fmt::format("{} {} is '{}': home, 0, must be in the range", travel_flag, name, value));
    travel[name[0]] = range;
  }
  return travel;
}

std::array<std::optional<double>, 3> squareness_of(const std::string& text) {
  constexpr std::array<std::string_view, 3> pairs = {"XY", "YZ", "ZX"};
  constexpr double most_um_per_m = 100000;  // 5.7 degrees; larger values have a wrong unit
  std::array<std::optional<double>, 3> squareness;
  for (const auto& [name, value] : entries_of(squareness_flag, text, "XY=-18")) {
    const auto found = std::find(pairs.begin(), pairs.end(), name);
    if (found == pairs.end())
      refuse_flags(fmt::format("{}: '{}' must be XY, YZ or ZX", squareness_flag, name));
    const double excess = number_of(fmt::format("{} {}", squareness_flag, name), value);
    if (std::abs(excess) > most_um_per_m)
      refuse_flags(
          fmt::format("{} {} is '{}', must be from -100000 to 100000 µm/m", squareness_flag, name, value));
    squareness[static_cast<std::size_t>(found - pairs.begin())] = excess;
  }
  return squareness;
}

Vector3 point_of(std::string_view flag, const std::string& text) {
  const std::vector<double> values = numbers_of(flag, text);
  if (values.size() != 3)
    refuse_flags(fmt::format("{}: '{}' has {} numbers, must be three", flag, text, values.size()));
  return {values[0], values[1], values[2]};
}

Vector3 tip_stiffness_of(const std::string& text) {
  const Vector3 k = point_of(tip_flag, text);
  if (!(k.minCoeff() > 0 && k.maxCoeff() <= 1e6))
    refuse_flags(
        fmt::format("{} is '{}', must be three numbers above 0 and at most 1000000", tip_flag, text));
  return k * N_per_um;
}

bool is_mill(MachineKind kind) {
  return kind < MachineKind::robot6r;
}

/// Throws for a flag that the kind does not use.
void refuse_other_flags(const NewOptions& given, const KindOfMachine& kind) {
  const MachineKind k = kind.kind;
  const bool bars = k == MachineKind::delta || k == MachineKind::orthoglide;
  const auto check = [&](const std::optional<std::string>& value, std::string_view flag, bool used,
                         std::string_view users) {
    if (value && !used)
      refuse_flags(fmt::format("a {} does not use {}; it is for {}", kind.name, flag, users));
  };
  constexpr std::string_view mills = "mill3, mill3-table, gantry, table-ac and table-bc";
  check(given.travel, travel_flag, !kind.travel.empty(), "all kinds but robot6r");
  check(given.squareness, squareness_flag, is_mill(k), mills);
  check(given.tip_stiffness, tip_flag, is_mill(k), mills);
  check(given.pivot, pivot_flag, k == MachineKind::table_ac || k == MachineKind::table_bc,
        "table-ac and table-bc");
  check(given.robot, robot_flag, k == MachineKind::robot6r, "robot6r");
  check(given.nodes, nodes_flag, k == MachineKind::hexapod, "hexapod");
  check(given.home, home_flag, k == MachineKind::hexapod, "hexapod");
  check(given.leg_stiffness, leg_flag, bars || k == MachineKind::hexapod, "hexapod, delta and orthoglide");
  check(given.arm, arm_flag, bars, "delta and orthoglide");
  check(given.radius, radius_flag, k == MachineKind::delta, "delta");
}

MachineFacts facts_of(const NewOptions& given) {
  const KindOfMachine& kind = kind_of(given.kind);
  refuse_other_flags(given, kind);
  MachineFacts facts;
  facts.kind = kind.kind;
  facts.name = without_controls(given.name);
  if (given.travel) facts.travel = travel_of(*given.travel, kind);
  if (given.squareness) facts.squareness_um_per_m = squareness_of(*given.squareness);
  if (given.tip_stiffness) facts.tip_stiffness = tip_stiffness_of(*given.tip_stiffness);
  if (given.pivot) facts.pivot_mm = point_of(pivot_flag, *given.pivot);
  facts.robot = given.robot.value_or("");
  if (given.nodes) {
    if (!given.home) refuse_flags("--nodes needs --home-mm X,Y,Z, the place of the platform in M at home");
    facts.nodes = read_leg_nodes(read_input(*given.nodes, ErrorKind::machine_or_force), *given.nodes);
  }
  if (given.home) facts.home_mm = point_of(home_flag, *given.home);
  const auto positive = [](const std::optional<std::string>& text, std::string_view flag, double unit) {
    return text ? std::optional(number_of(flag, *text, {0, true}) * unit) : std::nullopt;
  };
  facts.leg_stiffness = positive(given.leg_stiffness, leg_flag, N_per_um);
  facts.arm_mm = positive(given.arm, arm_flag, 1);
  facts.radius_mm = positive(given.radius, radius_flag, 1);
  return facts;
}

/// Throws `InputError` (ErrorKind::usage) if the flags make a machine without a home.
Machine read_back(const std::string& text) {
  try {
    Machine machine = read_machine(text, "new");
    refuse_home(prepare(machine), machine);
    return machine;
  } catch (const InputError& error) {
    refuse_flags(fmt::format("these flags make no machine that works: {}", error.what()));
  }
}

}  // namespace

std::optional<ErrorKind> run_new(const Options& options, Console& console) {
  if (options.create.robots) {
    write_result(robots_text());
    return std::nullopt;
  }
  const std::string text = machine_file(facts_of(options.create));
  const Machine machine = read_back(text);
  const std::string output = options.output.value_or("-");
  check_machine_output(
      output,
      options.create.nodes ? std::vector<std::string>{*options.create.nodes} : std::vector<std::string>{},
      options.force_overwrite);
  FileWriter file(output);
  file.write(text);
  publish_together({&file});
  if (output != "-")
    console.note(fmt::format("{}: {}\ncounterflex check {} shows the machine.\n", output,
                             numbers_phrase(machine), output));
  return std::nullopt;
}

}  // namespace counterflex::cli
