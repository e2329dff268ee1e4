#include "run/offsets.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/files/input_error.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex::cli {
namespace {

void refuse_uncontrolled(const Run& run) {
  const Machine& machine = run.machine.machine;
  for (const Component c : {Component::x, Component::y, Component::z})
    if (!controls(machine, c))
      throw InputError(ErrorKind::machine_or_force, {shown_name(run.machine.file.path)},
                       "--offsets needs a machine that controls x, y and z; `controlled` does not list all "
                       "of them");
}

/// Without a table the value that the control has is not known, unless the program gives it.
void refuse_unknown_value(const Run& run, std::size_t frame) {
  const Machine& machine = run.machine.machine;
  const ProgramFrame& in_program = run.program.frames[frame];
  if (machine.work_is_machine_frame || !machine.work.empty() || in_program.pose_mm) return;
  const std::string name = offset_name(run.program, in_program);
  if (name.empty()) return;
  throw InputError(
      ErrorKind::machine_or_force, {shown_name(run.machine.file.path)},
      fmt::format("--offsets needs the value of {0} that the control has, and no work offset is given; add "
                  "[work.{0}] with xyz_mm, or give --work {0}=X,Y,Z",
                  name));
}

// Places of cycles are not on the path that a run measures.
void add_holes(const Job& window, const std::vector<Waypoint>& waypoints, DeviationTally& holes) {
  for (const Waypoint& w : waypoints)
    if (w.status == Status::converged && is_place_of_cycle(window.program, w))
      holes.add({w.after, w.direction, w.tool_axis, 0, w.line, w.covariance ? &*w.covariance : nullptr});
}

DeviationStatistics with_holes(const DeviationTally& path, const DeviationTally& holes) {
  DeviationTally all = path;
  all.merge(holes);
  return all.statistics();
}

}  // namespace

OffsetSearch::OffsetSearch(Run& run) : run_(run), first_(freedom_) {
  refuse_uncontrolled(run);
  const Machine& machine = run.machine.machine;
  for (std::size_t i = 0; i < run.work.frames.size(); ++i) {
    const ProgramFrame& in_program = run.program.frames[i];
    if (run.program.frame_lines[i] > 0) refuse_unknown_value(run, i);
    Offset offset{offset_name(run.program, in_program), pose_of_offset(run.work.frames[i], in_program)};
    offset.is_set = is_set(in_program);
    if (const auto known = machine.work.find(offset.name); known != machine.work.end()) {
      const auto& touched = run.work.frames[i].touched;
      offset.is_touched = touched && !touched->axes.isZero(0);
      offset.is_stated = known->second.datum.stated();
    }
    const auto same = std::ranges::find_if(offsets_, [&](const Offset& other) {
      return other.name == offset.name && difference(other.X_MW, offset.X_MW).norm() < 1e-9;
    });
    freedom_.offset_of_frame.push_back(static_cast<std::size_t>(same - offsets_.begin()));
    if (same == offsets_.end()) offsets_.push_back(std::move(offset));
  }
  freedom_.offsets = offsets_.size();
  freedom_.turns = is_robot_dialect(run.program.dialect) && controls_pose(machine);
  freedom_.lengths = !run.program.turns_tool;
}

void OffsetSearch::add(const Job& window, const std::vector<Waypoint>& waypoints) {
  first_.add(window, waypoints);
  add_holes(window, waypoints, first_holes_);
}

std::optional<Failure> OffsetSearch::pass(const ConstantShift& shift, ShiftPlaces& found, Rest* rest,
                                          Console& console) const {
  ProgramReader reader(run_.file.bytes, run_.program.file, run_.read);
  RunInput input = run_.input();
  if (rest == nullptr) input.uncertainties = nullptr;  // bands are of the last pass
  JobWindows windows(input, reader);
  const auto read = [&](const Job& window) {
    const auto& segments = window.path.segments;
    console.solving(segments.empty() ? 0 : segments.front().line, run_.program.lines);
  };
  const auto begun = [&](const Job& window) {
    if (rest != nullptr) rest->tally.add_window(window);
  };
  const auto solved = [&](const Job& window, const std::vector<Waypoint>& waypoints) {
    found.add(window, waypoints);
    if (rest != nullptr) {
      rest->tally.add_waypoints(waypoints, window);
      add_holes(window, waypoints, rest->holes);
    }
    console.solved(waypoints.size());
  };
  return predict_shifted_windows(windows, run_.options.threads, shift,
                                 {read, begun, solved, [](const Job&, const Compensation&) {}});
}

/// Where the numbers of an offset are zero on the control (M, m).
Vector3 OffsetSearch::zero_of_control(const std::string& offset) const {
  const auto& work = run_.machine.machine.work;
  const auto known = work.find(offset);
  const bool has_numbers = known != work.end() && known->second.shown;
  return has_numbers ? Vector3(known->second.X_MW.p - *known->second.shown) : Vector3::Zero();
}

/// The shift of the rounded numbers, which are added to `result`.
BestShift OffsetSearch::written(const ControlWords& control, const BestShift& best,
                                BestOffsets& result) const {
  BestShift rounded = best;
  for (std::size_t i = 0; i < offsets_.size(); ++i) {
    const Pose& X_MW = offsets_[i].X_MW;
    rounded.offsets[i] = Pose{};
    if (!first_.has(i)) continue;
    const Vector3 zero = zero_of_control(offsets_[i].name);
    WrittenOffset offset =
        written_offset(control, offsets_[i].name, {X_MW.R, X_MW.p - zero}, best.offsets[i], freedom_.turns);
    offset.X_MW.p += zero;
    rounded.offsets[i] = offset.X_MW * inverse(X_MW);
    if (!freedom_.turns) rounded.offsets[i] = {Matrix3::Identity(), offset.X_MW.p - X_MW.p};
    BestOffsets::OfWork of{offsets_[i].name,
                           (offset.X_MW.p - X_MW.p) / mm,
                           {},
                           std::move(offset.change),
                           std::move(offset.words)};
    if (freedom_.turns) of.turn_deg = Vector3(rotation_between(offset.X_MW.R, X_MW.R) / deg);
    of.before_mm = first_.largest(i) / mm;
    result.work.push_back(std::move(of));
  }
  for (const long number : first_.tools()) {
    ChangedTool tool{number};
    const auto take = [&](std::map<long, double>& values, std::optional<double>& change) {
      const auto found = values.find(number);
      if (found == values.end()) return;
      found->second = rounded_length(control, found->second);
      if (found->second != 0) change = found->second;
    };
    take(rounded.lengths, tool.length);
    take(rounded.radii, tool.radius);
    if (!tool.length && !tool.radius) continue;
    if (const auto length = run_.tools.mm.find(number); length != run_.tools.mm.end())
      tool.length_now = length->second * mm;
    const auto& tools = run_.machine.machine.tools;
    if (const auto known = tools.find(number); known != tools.end() && known->second.diameter)
      tool.radius_now = *known->second.diameter / 2;
    const auto in_mm = [](const std::optional<double>& length) {
      return length ? std::optional(*length / mm) : std::nullopt;
    };
    result.tools.push_back({number, in_mm(tool.length), in_mm(tool.radius), tool_words(control, tool)});
  }
  return rounded;
}

std::vector<std::string> OffsetSearch::notes(const BestShift& best) const {
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < offsets_.size(); ++i) {
    const Offset& offset = offsets_[i];
    if (!first_.has(i)) continue;
    const std::string name = offset.name.empty() ? "base" : offset.name;
    if (offset.is_set) notes.push_back(fmt::format("The program sets {} itself: change it there.", name));
    if (offset.is_touched)
      notes.push_back(
          fmt::format("Add this to {} after the part was touched off; it is lost when the part "
                      "is touched off again.",
                      name));
    if (!offset.is_stated)
      notes.push_back(
          fmt::format("No datum is stated for {0}: if the part is touched off with this machine, "
                      "{0} contains a part of this shift already. State the datum first.",
                      name));
  }
  if (freedom_.turns)
    notes.emplace_back("The tool data stay as they are: only the base is moved and turned.");
  else if (first_.tools().size() < 2)
    notes.emplace_back("The tool length stays as it is: with one tool the work offset does the same.");
  else if (!freedom_.lengths)
    notes.emplace_back("Tool lengths stay as they are: the program turns the tool.");
  if (!freedom_.turns && first_.contours().empty())
    notes.emplace_back("Cutter radii stay as they are: the program has no contour under G41 or G42.");
  if (best.gap > 0.01 * um)
    notes.push_back(
        fmt::format("The search ended after {} passes: the least largest deviation may be {} mm "
                    "smaller.",
                    best.passes, format_fixed(best.gap / mm, 5)));
  return notes;
}

bool OffsetSearch::is_enough(const RunTally& tally) const {
  const FeedMoves moves = tally.feed_moves();
  if (moves.missed > 0 || moves.unknown > 0) return false;
  if (!run_.program.turns_tool) return true;
  const Measures measures = tally.path().measures();
  if (const auto& spin = run_.options.spin_tolerance)
    if (measures.after.statistics().max_rotation_deg * deg > *spin) return false;
  return std::ranges::all_of(measures.tools, [&](const auto& tool) {
    const auto& largest = tool.second.after.largest();
    return !largest || largest->tilt_deg * deg <= run_.options.tilt_tolerance;
  });
}

BestOffsets OffsetSearch::find(const Options& options, const RunReport& report, const RunTally& before,
                               Console& console) {
  const auto refuse = [&](const std::optional<Failure>& failure) {
    if (failure)
      throw InputError(failure->kind, {run_.program.file, failure->line},
                       "--offsets: with the shifted work offset: " + failure->what);
  };
  if (first_.tools().empty())
    throw InputError(ErrorKind::program_text, {run_.program.file},
                     "--offsets: no feed move of the program has a known position, so there is nothing to "
                     "shift; run predict without --offsets to see why");
  const auto search = [&](const ConstantShift& shift, ShiftPlaces& found) {
    return pass(shift, found, nullptr, console);
  };
  BestShift best = best_shift(freedom_, first_, search, run_.options.threads, &*run_.starts);
  refuse(best.failure);
  BestOffsets result;
  result.before = with_holes(before.path().measures().before, first_holes_);
  result.least_mm = best.largest / mm;
  const ControlWords control{run_.program.dialect, report.units.program, options.decimals};
  const BestShift rounded = written(control, best, result);
  Rest rest{RunTally(run_.facts.min_block_ms)};
  ShiftPlaces places(freedom_);
  refuse(pass(shift_of(freedom_, rounded), places, &rest, console));
  auto of = result.work.begin();
  for (std::size_t i = 0; i < offsets_.size(); ++i)
    if (first_.has(i)) (of++)->rest_mm = places.largest(i) / mm;
  result.rest = with_holes(rest.tally.path().measures().after, rest.holes);
  result.passes = best.passes + 1;
  result.is_enough = is_enough(rest.tally);
  result.notes = notes(best);
  return result;
}

}  // namespace counterflex::cli
