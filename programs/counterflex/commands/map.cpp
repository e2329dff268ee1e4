#include "counterflex/report/map.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "commands/commands.hpp"
#include "counterflex/files/file_writer.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/parameters.hpp"
#include "counterflex/program/program_reader.hpp"
#include "counterflex/toolpath/reach.hpp"
#include "process/standard_output.hpp"
#include "process/version.hpp"
#include "run/command_outputs.hpp"
#include "run/inputs.hpp"
#include "run/program_axes.hpp"
#include "run/reading.hpp"
#include "run/run_files.hpp"
#include "run/work.hpp"
#include "settings/values.hpp"

namespace counterflex::cli {
namespace {

[[noreturn]] void refuse_map(const std::string& what) {
  throw InputError(ErrorKind::usage, {}, what);
}

std::vector<double> map_numbers(std::string_view option, const std::string& text, std::size_t count) {
  const std::vector<double> values = numbers_of(option, text);
  if (values.size() != count)
    refuse_map(fmt::format("{}: '{}' has {} numbers, must be {}", option, text, values.size(), count));
  return values;
}

MapBox map_box_of(const std::string& text) {
  const std::vector<double> v = map_numbers("--box", text, 6);
  const MapBox box{Vector3(v[0], v[1], v[2]) * mm, Vector3(v[3], v[4], v[5]) * mm};
  if (!(box.least.array() <= box.most.array()).all())
    refuse_map(fmt::format("--box: '{}': X0, Y0, Z0 must not be above X1, Y1, Z1", text));
  return box;
}

std::array<int, 3> map_counts_of(const std::string& text) {
  constexpr int most_of_side = 1000, most_places = 1'000'000;
  const std::vector<double> values = map_numbers("--grid", text, 3);
  std::array<int, 3> count{};
  double places = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(values[k] >= 1 && values[k] <= most_of_side && values[k] == static_cast<int>(values[k])))
      refuse_map(fmt::format("--grid: '{}' must be three integers from 1 to {}", text, most_of_side));
    count[k] = static_cast<int>(values[k]);
    places *= values[k];
  }
  if (places > most_places)
    refuse_map(fmt::format("--grid: '{}' has {:.0f} places, must be at most {}", text, places, most_places));
  return count;
}

/// The values of options; the grid is still without a box if there is no --box.
struct MapValues {
  MapRequest request;
  bool has_box = false;
  std::array<int, 3> count{21, 21, 3};
  Vector3 rpy = Vector3::Zero();  ///< rad
};

/// Throws (ErrorKind::usage) for wrong values or combinations, before files are read.
MapValues map_values_of(const Options& options) {
  const MapOptions& map = options.map;
  if (map.stiffness && map.deviation) refuse_map("--stiffness and --deviation exclude each other");
  if (map.direction && map.deviation) refuse_map("--direction is of --stiffness; a deviation has its own");
  MapValues values;
  values.request.quantity = map.deviation ? MapQuantity::deviation : MapQuantity::stiffness;
  if (map.direction) values.request.direction = direction_of("--direction", *map.direction);
  values.request.load = {map.force.value_or(Vector6::Zero()), false};
  values.request.threads = options.threads;
  values.has_box = map.box.has_value();
  if (map.box) values.request.grid.box = map_box_of(*map.box);
  if (map.grid) values.count = map_counts_of(*map.grid);
  if (map.rpy) {
    const std::vector<double> v = map_numbers("--rpy", *map.rpy, 3);
    values.rpy = Vector3(v[0], v[1], v[2]) * deg;
    values.request.R_turn = from_rpy(values.rpy);
  }
  check_map_outputs(options);
  return values;
}

bool controls_orientation(const Mechanism& mechanism) {
  for (const Component component : mechanism.controlled)
    if (static_cast<int>(component) >= 3) return true;
  return mechanism.controlled.empty();  // then all components are followed
}

void add_to_box(const Extent& extent, MapBox& box) {
  box.least = box.least.cwiseMin(extent.least);
  box.most = box.most.cwiseMax(extent.most);
}

/// The feed moves of a window, and its holes from the height at which the feed begins to the bottom.
void add_to_box(const Program& window, const Toolpath& path, MapBox& box) {
  for (const Segment& segment : path.segments)
    if (segment.cutting) add_to_box(extent_of(segment.wanted), box);
  for (const Move& move : window.moves) {
    const Pose X_MW = wanted_frame(path.frames[move.frame]);
    for (const Curve& hole_mm : holes_of_cycle(move))
      add_to_box(extent_of(Curve{X_MW * (hole_mm.start * mm), X_MW * (hole_mm.end * mm)}), box);
  }
}

/// The box of the feed moves and holes of the program, in the machine frame. Puts external axes of the
/// machine where the program has them.
MapBox place_in_machine(const Options& options, const ToolLengths& lengths, MachineInput& input,
                        Console& console) {
  const ReadOptions read = read_options(options, &input.machine, lengths);
  ProgramFile file = open_program("program", options.program, options.data_lists, console);
  const Overview program = scan_program(options, file, read).program;
  for (const Remark& warning : place_program_axes(program, input))
    console.warning(program.file, warning.line, warning.what);
  const WorkPlace work = place_work(input.machine, input.model, shown_name(input.file.path), program);
  for (const Remark& warning : work.assumptions) console.warning(program.file, warning.line, warning.what);
  MapBox box{Vector3::Constant(HUGE_VAL), Vector3::Constant(-HUGE_VAL)};
  PathEnd end;
  for (ProgramReader reader(file.bytes, program.file, read); reader.next();) {
    const Toolpath path = build_toolpath(reader.window(), work.frames, end);
    end = path.end;
    add_to_box(reader.window(), path, box);
  }
  file.bytes.refuse_change();  // it was read more than once
  if (!box.least.allFinite())
    throw InputError(ErrorKind::program_text, {program.file},
                     "the program has no feed move with a known place, and no such hole, so it has no box; "
                     "leave it out, or give another program");
  return box;
}

void write_map(const WorkspaceMap& map, const Options& options) {
  std::optional<FileWriter> table, picture;
  if (options.output) table.emplace(*options.output).write(to_csv(map));
  if (options.map.plot) picture.emplace(*options.map.plot).write(map_picture(map));
  check_map_outputs(options);  // again: a foreign file may have appeared
  publish_together({if_any(table), if_any(picture)});
}

}  // namespace

std::optional<ErrorKind> run_map(const Options& options, Console& console) {
  const MapValues values = map_values_of(options);
  MachineInput input = read_machine_input(options);
  const ToolLengths lengths = read_tool_lengths(options, &input.machine);
  take_lengths(lengths, input.machine);
  std::optional<MapBox> program_box;
  if (!options.program.empty()) program_box = place_in_machine(options, lengths, input, console);
  WorkspaceMap map{version, input.model.mechanism.name, "", unmeasured_phrase(input.machine)};
  Model with_tool;
  if (options.map.tool) {
    const auto& [number, tool] = tool_named(*options.map.tool, input.machine);
    with_tool = prepare_with_tool(input.machine, input.model, tool);
    map.tool = fmt::format("tool T{}: {}", number, stiffness_phrase(tool));
  }
  const Model& model = options.map.tool ? with_tool : input.model;
  if (options.map.rpy && !controls_orientation(model.mechanism))
    refuse_map("--rpy: the machine does not control the orientation of its tip; leave out --rpy");
  map.weighs = has_weight(model.mechanism);
  map.rpy = values.rpy;
  map.request = values.request;
  MapBox box = values.request.grid.box;
  if (!values.has_box) {
    const std::optional<MapBox> reached = reached_box(model);
    if (!reached) refuse_map("the travel of the machine has no limits; give --box X0,Y0,Z0,X1,Y1,Z1");
    box = *reached;
  }
  map.request.grid = grid_of(box, values.count);
  console.progress("solving");
  map.places = map_places(model, map.request);
  if (program_box)
    map.program = place_program(map.request, map.places, shown_name(options.program), *program_box);
  console.finish_warnings();
  if (options.json)
    write_result(to_json(map));
  else if (options.output != "-")
    write_result(to_text(map));
  write_map(map, options);
  const MapRange range = range_of(map);
  if (range.solved > range.rigid) return std::nullopt;
  const bool is_reached = std::any_of(map.places.begin(), map.places.end(), [](const MapPlace& place) {
    return place.status != Status::unreachable && place.status != Status::outside_travel;
  });
  console.error(
      range.solved > 0
          ? "error: the machine is rigid at all places of the map: give its springs in the machine file"
      : is_reached
          ? fmt::format("error: no place of the map has a value: {}; give {}another --box, or another --rpy",
                        unsolved_text(map), options.map.force ? "a smaller --force, " : "")
          : "error: the machine has its tip at no place of the map: give another --box, or another --rpy");
  return ErrorKind::not_compensated;
}

}  // namespace counterflex::cli
