#include "run/work.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "counterflex/compensation/loads_along.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/turn.hpp"
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

/// Whether the program itself gives the whole position of the frame's offset.
bool has_place(const ProgramFrame& frame) {
  return frame.pose_mm || (frame.set_mm[0] && frame.set_mm[1] && frame.set_mm[2]);
}

/// Warns of offsets without a pose beside other offsets: they cannot all be the machine frame.
std::vector<Remark> no_table_warning(const Overview& program) {
  std::vector<std::string> in_use;
  bool others = false;
  for (std::size_t i = 0; i < program.frame_lines.size(); ++i) {
    if (program.frame_lines[i] == 0) continue;
    const std::string& offset = program.frames[i].work_offset;
    const std::string name = offset.empty() ? "none at first" : offset;
    if (has_place(program.frames[i]))
      others = true;
    else if (std::find(in_use.begin(), in_use.end(), name) == in_use.end())
      in_use.push_back(name);
  }
  const bool selects_none = in_use.size() == 1 && in_use[0] == "none at first";
  if (in_use.empty() || selects_none || (in_use.size() == 1 && !others)) return {};
  const bool one = in_use.size() == 1;
  return {{0, fmt::format(
                  "the program uses the offset{} {}, but no work offsets are given: {} taken as the machine "
                  "frame (give the pose with --work, or [work] in the machine file)",
                  one ? "" : "s", fmt::join(in_use, ", "), one ? "it is" : "these are")}};
}

std::vector<Remark> start_warning(const Overview& program) {
  if (program.frame_lines.empty() || program.frame_lines[0] == 0) return {};
  if (is_robot_dialect(program.dialect))
    return {{0, "the program selects no base: its targets are taken in the machine frame"}};
  return {
      {0, "the program does not select a work offset at first; G54, the default of controls, is assumed"}};
}

std::string numbers_in_words(const Vector3& v) {
  return fmt::format("({}, {}, {})", format_fixed(v.x(), 4), format_fixed(v.y(), 4), format_fixed(v.z(), 4));
}

std::string pose_in_words(const Pose& X) {
  return fmt::format("{} mm, roll, pitch, yaw {} deg", numbers_in_words(X.p / mm),
                     numbers_in_words(to_rpy(X.R) / deg));
}

/// Differences below these are roundings of a pendant.
constexpr double same_place = 0.01 * mm, same_turn = 0.01 * deg;

bool is_same(const Pose& a, const Pose& b) {
  return (a.p - b.p).norm() <= same_place && rotation_between(a.R, b.R).norm() <= same_turn;
}

/// The pose that the program gives, in m.
Pose given_pose(const ProgramFrame& frame) {
  return {frame.pose_mm->R, frame.pose_mm->p * mm};
}

/// Frames of one offset give one warning, with the first line.
void add_once(Remark warning, std::vector<Remark>& warnings) {
  const auto is_same_text = [&](const Remark& known) { return known.what == warning.what; };
  if (std::ranges::none_of(warnings, is_same_text)) warnings.push_back(std::move(warning));
}

/// Warns of poses in the table that the program does not use, because it gives others.
std::vector<Remark> pose_warnings(const std::map<std::string, WorkOffset>& work, const Overview& program) {
  std::vector<Remark> warnings;
  for (std::size_t i = 0; i < program.frame_lines.size(); ++i) {
    const ProgramFrame& frame = program.frames[i];
    if (program.frame_lines[i] == 0 || !frame.pose_mm) continue;
    const auto stated = work.find(frame.work_offset);
    if (stated == work.end() || is_same(stated->second.X_MW, given_pose(frame))) continue;
    add_once(
        {program.frame_lines[i],
         fmt::format("the program itself gives {} the pose {}. This pose is used, not that of [work.{}]: {}",
                     frame.work_offset, pose_in_words(given_pose(frame)), toml_key(frame.work_offset),
                     pose_in_words(stated->second.X_MW))},
        warnings);
  }
  return warnings;
}

/// Warns of a touched datum that does not act along axes in which the program sets the offset elsewhere.
void add_datum_warning(const WorkFrame& offset, const WorkFrame& placed, int line,
                       std::vector<Remark>& warnings) {
  if (!offset.touched || placed.touched->axes == offset.touched->axes) return;
  std::string axes;
  for (Eigen::Index k = 0; k < 3; ++k)
    if (placed.touched->axes[k] == 0) axes += fmt::format("{}{}", axes.empty() ? "" : ", ", "XYZ"[k]);
  add_once({line,
            fmt::format("the program itself sets {} of {} to another place than [work.{}], which was touched "
                        "off. There the offset counts as set independently of this machine's errors",
                        axes, offset.name, toml_key(offset.name))},
           warnings);
}

/// The position of `frame` in its offset, in m.
Pose placed(const ProgramFrame& frame) {
  Pose pose = in_offset(frame);
  pose.p *= mm;
  return pose;
}

/// The pose of `frame`. Its offset is at `offset`, and has there the numbers `shown` on the control (m;
/// empty: those of the machine frame), unless the program sets it. A datum that was touched off stays in the
/// axes in which the program sets the offset to its place.
WorkFrame place_frame(WorkFrame offset, const ProgramFrame& frame, const std::optional<Vector3>& shown = {}) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!frame.set_mm[axis]) continue;
    const auto k = static_cast<Eigen::Index>(axis);
    const double from_shown = shown ? offset.X_MW.p[k] - (*shown)[k] : 0;
    const double before = std::exchange(offset.X_MW.p[k], *frame.set_mm[axis] * mm + from_shown);
    if (std::abs(offset.X_MW.p[k] - before) <= same_place) continue;
    offset.datum_shift[k] = 0;
    if (offset.touched) offset.touched->axes[k] = 0;
  }
  offset.X_MW = offset.X_MW * placed(frame);
  return offset;
}

/// Where `frame` was touched off.
void touch(WorkFrame& frame, const Datum& datum, const Model& model, const std::string& machine_file) {
  if (!datum.touched_at) return;
  frame.touched = {.p_MT = frame.X_MW * *datum.touched_at};
  frame.datum_shift = deviation_at(model, frame.touched->p_MT, machine_file, frame.name);
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
  touch(frame, found->second.datum, model, machine_file);
  return frame;
}

/// An offset whose pose the program gives. The table may have its datum, beside the same pose.
WorkFrame place_given(const Machine& machine, const Model& model, const std::string& machine_file,
                      const ProgramFrame& in_program, int line) {
  WorkFrame frame{in_program.work_offset, given_pose(in_program)};
  const auto stated = machine.work.find(frame.name);
  if (stated == machine.work.end()) return frame;
  const Pose& X_MW = stated->second.X_MW;
  if (stated->second.datum.touched_at && !is_same(X_MW, frame.X_MW))
    throw InputError(
        ErrorKind::machine_or_force, {machine_file},
        fmt::format("[work.{}] was touched off at the pose {}, but the program gives {} the pose {}, in use "
                    "from line {} on. Both must be the same within 0.01 mm and 0.01 deg: correct the one "
                    "that is wrong, or state datum = \"machine\"",
                    toml_key(frame.name), pose_in_words(X_MW), frame.name, pose_in_words(frame.X_MW), line));
  touch(frame, stated->second.datum, model, machine_file);
  return frame;
}

WorkPlace in_machine_frame(const Overview& program) {
  WorkPlace place;
  for (const ProgramFrame& frame : program.frames) {
    WorkFrame offset;
    if (frame.pose_mm) offset = {frame.work_offset, given_pose(frame)};
    place.frames.push_back(place_frame(offset, frame));
  }
  return place;
}

}  // namespace

bool is_placed_by_program(const Overview& program, const ProgramFrame& frame) {
  return frame.pose_mm || (is_robot_dialect(program.dialect) && frame.work_offset.empty());
}

WorkPlace place_work(const Machine& machine, const Model& model, const std::string& machine_file,
                     const Overview& program) {
  WorkPlace place = in_machine_frame(program);
  if (machine.work_is_machine_frame) return place;
  if (machine.work.empty()) {
    place.assumptions = no_table_warning(program);
    return place;
  }
  std::optional<Model> cold;
  if (machine.temperature) cold = prepare(without_temperature(machine));
  const Model& touching = cold ? *cold : model;
  std::map<std::string, WorkFrame> offsets;  // solved once for all frames of an offset
  for (std::size_t i = 0; i < program.frame_lines.size(); ++i) {
    if (program.frame_lines[i] == 0) continue;
    if (program.frames[i].pose_mm)
      place.frames[i] =
          place_frame(place_given(machine, touching, machine_file, program.frames[i], program.frame_lines[i]),
                      program.frames[i]);
    if (is_placed_by_program(program, program.frames[i])) continue;
    const std::string& selected = program.frames[i].work_offset;
    auto offset = offsets.find(selected);
    if (offset == offsets.end())
      offset = offsets.emplace(selected, place_offset(machine, touching, machine_file, selected)).first;
    place.frames[i] =
        place_frame(offset->second, program.frames[i], machine.work.at(offset->second.name).shown);
    add_datum_warning(offset->second, place.frames[i], program.frame_lines[i], place.assumptions);
  }
  std::ranges::move(start_warning(program), std::back_inserter(place.assumptions));
  std::ranges::move(pose_warnings(machine.work, program), std::back_inserter(place.assumptions));
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
  place.assumptions = start_warning(program);
  std::ranges::move(pose_warnings(table, program), std::back_inserter(place.assumptions));
  return place;
}

std::optional<Pose> known_frame(const Machine& machine, const ProgramFrame& frame) {
  WorkFrame offset;
  std::optional<Vector3> shown;
  if (frame.pose_mm) offset.X_MW = given_pose(frame);
  if (!frame.work_offset.empty() && !machine.work.empty() && !machine.work_is_machine_frame) {
    const auto found = machine.work.find(frame.work_offset);
    const bool is_stated = found != machine.work.end();
    if (is_stated ? found->second.datum.touched_at.has_value() : !frame.pose_mm) return std::nullopt;
    if (!frame.pose_mm) offset.X_MW = found->second.X_MW;
    if (!frame.pose_mm) shown = found->second.shown;
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
  for (std::size_t i = 0; i < program.frame_lines.size(); ++i) {
    if (program.frame_lines[i] == 0) continue;
    const ProgramFrame& in_program = program.frames[i];
    const auto offset = machine.work.find(frames[i].name);
    if (offset != machine.work.end() && offset->second.datum.stated()) continue;
    const std::string selected = PathPlaces::offset_of(in_program);
    const auto [known, is_new] = shifts.try_emplace(selected);
    if (is_new)
      known->second = common_shift(model, in_program.pose_mm ? Pose{} : pose_of_offset(frames[i], in_program),
                                   places.of(selected), &starts, threads);
    frames[i].common_shift = known->second;
  }
}

}  // namespace counterflex::cli
