#include "counterflex/report/run_tally.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/compensation/loads_along.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/toolpath/reach.hpp"
#include "report/tally/may_cut.hpp"
#include "report/text/control.hpp"
#include "report/text/tool_words.hpp"

namespace counterflex {

std::int32_t OperationNames::number_of(const Program& window, const Move& move) {
  const std::string operation = without_controls(window.operation_titles[move.operation]);
  const auto is_it = [&](const Name& name) { return name.tool == move.tool && name.operation == operation; };
  if (last_ >= 0 && is_it(names_[static_cast<std::size_t>(last_)])) return last_;
  std::size_t i =
      static_cast<std::size_t>(std::find_if(names_.begin(), names_.end(), is_it) - names_.begin());
  if (i == names_.size() && i < listed_at_most)
    names_.push_back(i + 1 < listed_at_most ? Name{move.tool, operation} : Name{0, "other operations"});
  i = std::min(i, listed_at_most - 1);
  return last_ = static_cast<std::int32_t>(i);
}

RunTally::RunTally(double min_block_ms, std::optional<PathCurves> curves, std::vector<ToolSize> tools)
    : min_block_ms_(min_block_ms), tools_(std::move(tools)), curves_(std::move(curves)) {}

ToolSize RunTally::size_of(long tool) const {
  const auto known =
      std::find_if(tools_.begin(), tools_.end(), [&](const ToolSize& size) { return size.number == tool; });
  return known != tools_.end() ? *known : ToolSize{tool, {}, {}};
}

ToolSize RunTally::size_in(const NarrowedContour& contour) const {
  ToolSize tool = size_of(contour.tool);
  if (contour.diameter_mm) tool.diameter = *contour.diameter_mm * mm;
  return tool;
}

MoveFacts RunTally::facts_of(const Job& window, const Waypoint& w) const {
  const Move& move = window.program.moves[w.move];
  return {window.path.frames[move.frame].common_shift.value_or(Vector3::Zero()), size_of(move.tool),
          !w.cutting};
}

void RunTally::add(const Waypoint& w, std::int32_t operation, const MoveFacts& facts, bool is_within) {
  path_.add(w, operation, facts, is_within);
  feed_force_.add(w);
  if (curves_) curves_->add(w, operation);
}

void RunTally::add_waypoints(const std::vector<Waypoint>& waypoints) {
  for (const Waypoint& w : waypoints) add(w, PathTally::no_operation, {}, true);
}

void RunTally::add_waypoints(const std::vector<Waypoint>& waypoints, const Job& window) {
  std::size_t segment = no_segment;
  std::int32_t operation = PathTally::no_operation;
  MoveFacts facts;
  for (const Waypoint& w : waypoints) {
    if (w.segment != segment || segment == no_segment) {
      segment = w.segment;
      operation = PathTally::no_operation;
      facts = {};
      const Move& move = window.program.moves[w.move];
      if (tool_cuts_at(window.program, w)) {
        facts = facts_of(window, w);
        operation = operation_names_.number_of(window.program, move);
        if (!unit_) unit_ = move.unit;
      }
      facts.is_own = move.handling == Handling::own;
    }
    const double miss = position_miss(window, w);
    feed_.add(w, miss, window);
    if (window.options.only_significant) add_as_programmed(w, tool_cuts_at(window.program, w));
    add(w, operation, facts, is_within_tolerance(window.options, miss));
  }
  add_to_travel(waypoints, window);
  list_corners(waypoints, window);
}

namespace {

std::string words_of_corner(const CornerSize& size, double miss) {
  const bool is_round = size.kind == CornerKind::round, is_known = size.mm >= 0;
  return fmt::format(
      "the {} at its end misses by up to {:.4f} mm{}: the control puts it between corrected lines, and it is "
      "not "
      "corrected itself; write it as {}, or make it smaller",
      is_round ? "rounding" : "chamfer", miss / mm, is_known ? "" : " (size not known, as large as fits)",
      is_round ? "an arc" : "a line");
}

}  // namespace

void RunTally::list_corners(const std::vector<Waypoint>& waypoints, const Job& window) {
  for (auto w = waypoints.begin(); w != waypoints.end();) {
    const std::size_t move = w->move;
    double worst = 0;
    for (; w != waypoints.end() && w->move == move; ++w)
      if (w->in_corner && !w->insignificant) worst = std::max(worst, position_miss(window, *w));
    if (is_within_tolerance(window.options, worst)) continue;
    const Move& before = window.program.moves[move];
    list(left_alone_, LeftAlone{before.line, words_of_corner(before.corners->end_size, worst)});
  }
}

void RunTally::add_as_programmed(const Waypoint& w, bool cuts) {
  if (!as_programmed_) as_programmed_.emplace();
  as_programmed_->add(w, cuts);
}

void RunTally::add_to_travel(const std::vector<Waypoint>& waypoints, const Job& window) {
  const OutermostCommands commands = outermost_commands(window, waypoints);
  const auto actuators = actuators_at(window, commands.positions);
  for (std::size_t i = 0, k = 0; i < waypoints.size(); ++i) {
    const Waypoint& w = waypoints[i];
    const Mechanism& mechanism = model_of(window, w.move).mechanism;
    for (; k < actuators.size() && commands.waypoints[k] == i; ++k)
      if (actuators[k])
        travel_.add(mechanism, *actuators[k], w.line);
      else
        travel_.skip(w.line);
    if (w.status == Status::converged) travel_.add(mechanism, w.rho, w.line);
  }
}

namespace {

/// Whether a cycle is called where the tool already is: no waypoint is there.
bool drills_without_waypoint(const Move& move) {
  return move.makes_hole && all_known(move.known_start) && all_known(move.known_end) &&
         move.start_mm == move.end_mm;
}

}  // namespace

void RunTally::add_window(const Job& window) {
  feed_.add_window(window);
  for (const Move& move : window.program.moves)
    if (goes_to_unknown_places(move) || drills_without_waypoint(move)) travel_.skip(move.line);
  if (parts_corner(window.program))
    list(left_alone_, LeftAlone{window.program.moves.back().line,
                                "the corner at its end is not judged: too many corners follow one another"});
  add_forces(window.forces);
  add_reversals(window);
}

namespace {

std::string words_of(const DoubtfulDirection& doubt, const Mechanism& mechanism) {
  const Travel& travel = mechanism.travel[doubt.actuator];
  const bool slides = travel.kind == JointKind::prismatic;
  return fmt::format(
      "from which side {} came here is not known: its position before line {} is not. The direction of its "
      "last known motion counts; in the other one it is {:.4g} {} off",
      travel.name, doubt.lost_before, mechanism.reversal[doubt.actuator] / (slides ? um : deg / 1000),
      slides ? "um" : "mdeg");
}

}  // namespace

void RunTally::add_reversals(const Job& window) {
  if (window.directions == nullptr) return;
  if (!reversals_) reversals_.emplace();
  for (const DirectionChange& change : window.directions->changes())
    if (change.is_reversal)
      list(*reversals_, ReversalRow{window.program.moves[change.move].line,
                                    window.model.mechanism.travel[change.actuator].name});
  for (const DoubtfulDirection& doubt : window.directions->doubtful())
    list(direction_notes_, Remark{doubt.line, words_of(doubt, window.model.mechanism)});
}

FeedMoves RunTally::feed_moves() const {
  FeedMoves moves = feed_.moves();
  moves.within_mm += path_.measures().accepted_mm;
  return moves;
}

void RunTally::add_forces(const PathForces& forces) {
  forces_.at_platform = forces.at_platform();
  forces_.ramps += forces.ramps();
  forces_.jumps += forces.jumps();
  forces_.largest_step_N = std::max(forces_.largest_step_N, forces.largest_step_N());
  if (curves_)
    for (const double s : forces.steps()) curves_->add_force_step(s / mm);
  for (const Unforced& move : forces.unforced()) add_unforced(forces_.without, move);
  for (const ForceNote& note : forces.notes()) list(force_notes_, Remark{note.line, note.what});
}

void RunTally::add_compensation(const Compensation& compensation) {
  corrected_moves_ += compensation.corrected_moves;
  other_moves_.grouped += compensation.other_moves.grouped;
  other_moves_.held += compensation.other_moves.held;
  other_moves_.in_part += compensation.other_moves.in_part;
  other_moves_.left += compensation.other_moves.left;
  inserted_blocks_ += compensation.counts.inserted_blocks;
  text_bytes_ += compensation.text.size();
  for (const LeftAlone& block : compensation.left_alone) list(left_alone_, block);
  for (const NarrowedContour& contour : compensation.narrowed) {
    const ToolSize tool = size_in(contour);
    if (may_not_pass(contour, tool) && !passes_only_programmed(contour, tool))
      list(contour_notes_, Remark{contour.line, narrowed_in_words(contour, tool)});
  }
}

std::optional<Failure> RunTally::contour_failure(const Compensation& compensation) const {
  for (const NarrowedContour& contour : compensation.narrowed)
    if (const ToolSize tool = size_in(contour); passes_only_programmed(contour, tool))
      return Failure{ErrorKind::not_compensated, contour.line,
                     "verification failed: " + narrowed_in_words(contour, tool)};
  return std::nullopt;
}

void RunTally::add_corrected(const Program& corrected_window) {
  if (!lines_) lines_.emplace();
  if (!short_blocks_) short_blocks_.emplace().limit_ms = min_block_ms_;
  add_lines(*lines_, corrected_window.text, corrected_window.dialect);
  add_short_blocks(*short_blocks_, corrected_window);
  zones_ = corrected_window.zones;
}

}  // namespace counterflex
