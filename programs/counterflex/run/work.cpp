#include "run/work.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "counterflex/compensation/loads_along.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/settings/project_file.hpp"
#include "settings/values.hpp"

namespace counterflex::cli {
namespace {

constexpr const char* power_on_offset = "G54";

template <typename Place>
std::string names(const std::map<std::string, Place>& work) {
  std::string text;
  for (const auto& [name, offset] : work) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// Deviation of the unloaded machine's tip at the touched point.
Vector3 deviation_at(const Model& model, const Vector3& p_MT, const std::string& file,
                     const std::string& offset) {
  const auto fail = [&](Status status) {
    throw InputError(
        ErrorKind::machine_or_force, {file},
        fmt::format(
            "[work.{}] was touched off at ({:.6g}, {:.6g}, {:.6g}) mm of the machine frame, which the "
            "machine does not reach: {}. The point is given in coordinates of the offset itself",
            offset, p_MT.x() / mm, p_MT.y() / mm, p_MT.z() / mm, to_string(status)));
  };
  const UnloadedDeviation touched = unloaded_deviation({&model, p_MT});
  if (touched.status != Status::converged) fail(touched.status);
  return touched.d;
}

/// Warns of several offsets in use without poses: they cannot all be the machine frame.
std::string no_table_warning(const Overview& program) {
  std::vector<std::string> in_use;
  for (std::size_t i = 0; i < program.frame_lines.size(); ++i) {
    const std::string& offset = program.frames[i].work_offset;
    const std::string name = offset.empty() ? "none at first" : offset;
    const bool listed = std::find(in_use.begin(), in_use.end(), name) != in_use.end();
    if (program.frame_lines[i] > 0 && !listed) in_use.push_back(name);
  }
  if (in_use.size() < 2) return "";
  return fmt::format(
      "the program uses the offsets {}, but no work offsets are given: all are taken as the machine frame "
      "(give their poses with --work, or "
      "[work] "
      "in the machine file)",
      fmt::join(in_use, ", "));
}

std::string start_warning(const Overview& program) {
  if (program.frame_lines.empty() || program.frame_lines[0] == 0) return "";
  if (is_robot_dialect(program.dialect))
    return "the program selects no base: its targets are taken in the machine frame";
  return "the program does not select a work offset at first; G54, the default of controls, is assumed";
}

/// The position of `frame` in its offset, in m.
Pose placed(const ProgramFrame& frame) {
  Pose pose = in_offset(frame);
  pose.p *= mm;
  return pose;
}

/// The pose of `frame`. Its offset is at `offset`, and has there the numbers `shown` on the control (m;
/// empty: those of the machine frame), unless the program sets it.
WorkFrame place_frame(WorkFrame offset, const ProgramFrame& frame, const std::optional<Vector3>& shown = {}) {
  if (frame.pose_mm) offset = {frame.work_offset, Pose{frame.pose_mm->R, frame.pose_mm->p * mm}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!frame.set_mm[axis]) continue;
    const auto k = static_cast<Eigen::Index>(axis);
    const double from_shown = shown ? offset.X_MW.p[k] - (*shown)[k] : 0;
    offset.X_MW.p[k] = *frame.set_mm[axis] * mm + from_shown;
    offset.datum_shift[k] = 0;
    if (offset.touched) offset.touched->axes[k] = 0;
  }
  offset.X_MW = offset.X_MW * placed(frame);
  return offset;
}

/// The offset; program coordinates may be shifted and rotated in it.
WorkFrame place_offset(const Machine& machine, const Model& model, const std::string& machine_file,
                       const std::string& selected) {
  const std::string name = selected.empty() ? power_on_offset : selected;
  const auto found = machine.work.find(name);
  if (found == machine.work.end())
    throw InputError(
        ErrorKind::machine_or_force, {machine_file},
        fmt::format(
            "no [work.{0}], which the program {1}; the offsets are {2}. Add [work.{0}], or give --work "
            "'{3}=X,Y,Z/DATUM'",
            toml_key(name), selected.empty() ? "starts with" : "selects", names(machine.work), name));
  WorkFrame frame{name, found->second.X_MW};
  if (const auto& touched = found->second.datum.touched_at) {
    frame.touched = {.p_MT = frame.X_MW * *touched};
    frame.datum_shift = deviation_at(model, frame.touched->p_MT, machine_file, name);
  }
  return frame;
}

/// Whether no work offset is needed: the program gives the pose of its base, or a robot program selects
/// none.
bool is_placed_by_program(const Overview& program, const ProgramFrame& frame) {
  return frame.pose_mm || (is_robot_dialect(program.dialect) && frame.work_offset.empty());
}

WorkPlace in_machine_frame(const Overview& program) {
  WorkPlace place;
  for (const ProgramFrame& frame : program.frames) place.frames.push_back(place_frame({}, frame));
  return place;
}

}  // namespace

WorkPlace place_work(const Machine& machine, const Model& model, const std::string& machine_file,
                     const Overview& program) {
  WorkPlace place = in_machine_frame(program);
  if (machine.work_is_machine_frame) return place;
  if (machine.work.empty()) {
    place.assumption = no_table_warning(program);
    return place;
  }
  std::optional<Model> cold;
  if (machine.temperature) cold = prepare(without_temperature(machine));
  const Model& touching = cold ? *cold : model;
  std::map<std::string, WorkFrame> offsets;  // solved once for all frames of an offset
  for (std::size_t i = 0; i < program.frame_lines.size(); ++i) {
    if (program.frame_lines[i] == 0) continue;
    if (is_placed_by_program(program, program.frames[i])) continue;
    const std::string& selected = program.frames[i].work_offset;
    auto offset = offsets.find(selected);
    if (offset == offsets.end())
      offset = offsets.emplace(selected, place_offset(machine, touching, machine_file, selected)).first;
    place.frames[i] =
        place_frame(offset->second, program.frames[i], machine.work.at(offset->second.name).shown);
  }
  place.assumption = start_warning(program);
  return place;
}

WorkPlace place_work(const std::vector<std::string>& given, const Overview& program) {
  WorkPlace place = in_machine_frame(program);
  std::map<std::string, WorkOffset> table;
  for (const std::string& text : given)
    if (WorkText work = work_of(text); !work.offset.empty()) table[work.offset] = std::move(work.place);
  if (table.empty()) return place;
  for (std::size_t i = 0; i < program.frame_lines.size(); ++i) {
    if (program.frame_lines[i] == 0) continue;
    if (is_placed_by_program(program, program.frames[i])) continue;
    const std::string& selected = program.frames[i].work_offset;
    const std::string name = selected.empty() ? power_on_offset : selected;
    const auto found = table.find(name);
    if (found == table.end())
      throw InputError(ErrorKind::usage, {},
                       fmt::format("--work does not give {}, which the program {}; it gives {}", name,
                                   selected.empty() ? "starts with" : "selects", names(table)));
    place.frames[i] = place_frame({name, found->second.X_MW}, program.frames[i], found->second.shown);
  }
  place.assumption = start_warning(program);
  return place;
}

std::optional<Pose> known_frame(const Machine& machine, const ProgramFrame& frame) {
  WorkFrame offset;
  std::optional<Vector3> shown;
  const bool is_in_table = !frame.pose_mm && !frame.work_offset.empty() && !machine.work.empty();
  if (is_in_table && !machine.work_is_machine_frame) {
    const auto found = machine.work.find(frame.work_offset);
    if (found == machine.work.end() || found->second.datum.touched_at) return std::nullopt;
    offset.X_MW = found->second.X_MW;
    shown = found->second.shown;
  }
  return place_frame(offset, frame, shown).X_MW;
}

Pose pose_of_offset(const WorkFrame& frame, const ProgramFrame& in_program) {
  return frame.X_MW * inverse(placed(in_program));
}

std::string offset_name(const Overview& program, const ProgramFrame& frame) {
  if (!frame.work_offset.empty() || is_robot_dialect(program.dialect)) return frame.work_offset;
  return power_on_offset;
}

void add_common_shifts(const Machine& machine, const Model& model, const StartTables& starts,
                       const PathPlaces& places, const Overview& program, int threads,
                       std::vector<WorkFrame>& frames) {
  if (machine.work_is_machine_frame) return;
  std::map<std::string, std::optional<Vector3>> shifts;  // by offset, for all its frames
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto offset = machine.work.find(frames[i].name);
    if ((offset != machine.work.end() && offset->second.datum.stated()) || is_set(program.frames[i]))
      continue;
    const std::string& selected = program.frames[i].work_offset;
    const auto [known, is_new] = shifts.try_emplace(selected);
    if (is_new)
      known->second = common_shift(model, pose_of_offset(frames[i], program.frames[i]), places.of(selected),
                                   &starts, threads);
    frames[i].common_shift = known->second;
  }
}

}  // namespace counterflex::cli
