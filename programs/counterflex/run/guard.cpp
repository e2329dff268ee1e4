#include "run/guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "counterflex/compensation/offset_window.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/program/program_reader.hpp"
#include "run/windows.hpp"

namespace counterflex::cli {
namespace {

constexpr const char* power_on_offset = "G54";

/// The first cut of a program, with its frame.
struct Cut {
  Move move;
  ProgramFrame frame;
};

Cut find_first_cut(Run& run) {
  ProgramReader reader(run.file.bytes, run.program.file, run.read);
  std::optional<Cut> cut;
  while (reader.next()) {
    const Program& window = reader.window();
    if (const std::string name = reserved_for_guard(run.program.dialect, window.text); !name.empty())
      throw InputError(
          ErrorKind::program_text, {run.program.file, 1, 1},
          fmt::format("the program uses {}, which the checks of --guard need for themselves: use "
                      "another one, or leave out --guard",
                      name));
    const Move* move = cut ? nullptr : first_cut(window);
    if (move != nullptr) cut = Cut{*move, window.frames[move->frame]};
  }
  if (cut) return *cut;
  throw InputError(
      ErrorKind::program_text, {run.program.file, 1, 1},
      "no feed move is before the end of the program: --guard has nothing to guard, leave it out");
}

[[noreturn]] void refuse_unknown_numbers(const Run& run, const std::string& name) {
  const std::string why =
      run.machine.machine.work_is_machine_frame
          ? fmt::format(
                "but the work is taken in the machine frame (--work machine, work = \"machine\"): give "
                "--work {}=X,Y,Z/machine/offset=X,Y,Z instead",
                name)
          : fmt::format(
                "which are not known: add offset_mm = [x, y, z] to [work.{0}] here or in the project "
                "file, or give --work {0}=X,Y,Z/offset=X,Y,Z",
                name);
  throw InputError(ErrorKind::machine_or_force, {shown_name(run.machine.file.path)},
                   fmt::format("--guard compares the numbers of {} on the control, {}", name, why));
}

GuardedOffset offset_of(const Run& run, const Cut& cut) {
  const bool robot = is_robot_dialect(run.program.dialect);
  const std::string name = cut.frame.work_offset.empty() && !robot ? power_on_offset : cut.frame.work_offset;
  const auto& work = run.machine.machine.work;
  const auto found = work.find(name);
  const WorkFrame& placed = run.work.frames[cut.move.frame];
  if (!robot && is_set(cut.frame))
    throw InputError(ErrorKind::program_text, {run.program.file, cut.move.line, 1},
                     fmt::format("the program sets {} itself before its first cut, in this line: --guard has "
                                 "nothing to guard, leave it out",
                                 name));
  if (found != work.end() && found->second.shown)
    return {name, *found->second.shown / mm, found->second.X_MW.R};
  if (robot) return {name, placed.X_MW.p / mm, placed.X_MW.R};
  refuse_unknown_numbers(run, name);
}

/// In deg; empty for a frame whose z axis is another one.
std::optional<double> turn_about_z(const Matrix3& R) {
  constexpr double rounding = 1e-9;
  if (!(R(2, 2) > 1 - rounding)) return std::nullopt;
  const double turn = std::atan2(R(1, 0), R(0, 0)) / deg;
  return std::abs(turn) < rounding ? 0 : turn;
}

Guard guard_of(const Run& run, const Cut& cut) {
  Guard guard;
  guard.active = offset_of(run, cut);
  const bool robot = is_robot_dialect(run.program.dialect);
  guard.tool = robot || cut.move.tool_in_spindle ? cut.move.tool : 0;
  guard.is_chosen = cut.move.tool_is_chosen;
  if (const auto length = run.tools.mm.find(guard.tool);
      cut.move.has_tool_length && length != run.tools.mm.end())
    guard.length_mm = length->second;
  guard.unit = cut.move.unit;
  guard.control = run.read.unit.value_or(LengthUnit::millimetres);
  guard.program_shifts = !cut.frame.origin_mm.isZero(0) || cut.frame.turn_rad != 0;
  guard.turn_deg = turn_about_z(*guard.active.R);
  return guard;
}

/// The places at which the window is solved: those of the corrected program that use up most of the
/// tolerance. Empty where the compensation fails.
std::optional<std::vector<LoadPlace>> corrected_places(Run& run, Console& console) {
  Windows windows(run, console);
  LoadPlaces places(KeptPlace::largest_rest);
  WindowEvents events;
  events.read = [](const Job&) {};
  events.begun = [](const Job&) {};
  events.done = [](const Job&, const Compensation&) {};
  events.solved = [&](const Job& window, const std::vector<Waypoint>& waypoints) {
    places.add(window, waypoints);
  };
  const bool failed =
      compensate_windows(windows.jobs(), run.options, TextReader(windows.reader()), false, events)
          .has_value();
  return failed ? std::nullopt : std::optional(places.places());
}

double window_of(const Run& run, const Cut& cut, const Guard& guard, const std::vector<LoadPlace>& places) {
  std::optional<long> tool;
  if (guard.length_mm && run.tool_models.contains(guard.tool)) tool = guard.tool;
  if (const std::optional<double> window = window_of(run, tool, places)) return *window;
  throw InputError(
      ErrorKind::not_compensated, {run.program.file, cut.move.line, 1},
      fmt::format(
          "no guard is possible: with the work offset or the tool length off by {} mm the deviation is "
          "above the tolerance of {:.4f} mm; allow a larger --tolerance-mm, or leave out --guard",
          *std::rbegin(window_steps_mm), run.options.tolerance / mm));
}

}  // namespace

std::optional<double> window_of(const Run& run, std::optional<long> tool,
                                const std::vector<LoadPlace>& places) {
  OffsetQuestion question{places, run.options, run.machine.machine, run.machine.model, run.work.frames};
  question.tool = tool;
  question.turns = is_robot_dialect(run.program.dialect);
  question.starts = &*run.starts;
  const std::optional<double> window = offset_window(question);
  return window ? std::optional(*window / mm) : std::nullopt;
}

void expect_guard(Run& run) {
  try {
    Guard guard = guard_of(run, find_first_cut(run));
    if (why_no_guard(run.program.dialect, guard).empty()) run.options.write.guard = std::move(guard);
  } catch (const InputError&) {  // such a program gets no guard
  }
}

void prepare_guard(Run& run, Console& console) {
  const Cut cut = find_first_cut(run);
  const auto refuse = [&](const std::string& why) {
    if (!why.empty()) throw InputError(ErrorKind::usage, {run.program.file, cut.move.line, 1}, why);
  };
  Guard guard;
  const bool is_default = cut.frame.work_offset.empty() && !is_robot_dialect(run.program.dialect);
  guard.active.name = is_default ? power_on_offset : cut.frame.work_offset;
  guard.unit = cut.move.unit;
  guard.control = run.read.unit.value_or(LengthUnit::millimetres);
  refuse(why_no_guard(run.program.dialect, guard));
  guard = guard_of(run, cut);
  refuse(why_no_guard(run.program.dialect, guard));
  console.progress("finding the window of the guard");
  const auto places = corrected_places(run, console);
  if (!places) return;
  guard.window_mm = window_of(run, cut, guard, *places);
  run.options.write.guard = guard;
  run.facts.guard = WrittenGuard{guard, cut.move.line, places->size()};
}

}  // namespace counterflex::cli
