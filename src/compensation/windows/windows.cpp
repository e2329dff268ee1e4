#include "counterflex/compensation/windows.hpp"

#include <algorithm>
#include <future>

#include "compensation/plan/places.hpp"
#include "compensation/solve/branch.hpp"
#include "compensation/solve/commands.hpp"
#include "compensation/solve/solver.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

constexpr int orientations_of_segment = eighths + 1;

// A place that is not reached fails where it is solved.
std::vector<Matrix3> orientations_at(const RunInput& input, const std::vector<TipPosition>& places) {
  std::vector<WantedPose> wanted(places.size());
  PlaceSolver(input.starts, acts_at_platform(input.source)).wanted(places, wanted, StopAt::end);
  std::vector<Matrix3> R_MT;
  for (const WantedPose& pose : wanted) R_MT.push_back(pose.X_MT.R);
  return R_MT;
}

// At equal fractions of every segment, or in its middle.
std::vector<Matrix3> sampled_orientations(const RunInput& input, const Program& window, const Toolpath& path,
                                          int each) {
  std::vector<TipPosition> places;
  for (const Segment& segment : path.segments)
    for (int k = 0; k < each; ++k) {
      const double u = each == 1 ? 0.5 : static_cast<double>(k) / (each - 1);
      const Model& model = model_with(input.model, input.tools, window.moves[segment.move].tool);
      places.push_back({&model, point_at(segment.wanted, u), orientation_at(segment, u)});
    }
  return orientations_at(input, places);
}

// Sets the wanted turns about the spindle axis. `first`: number of the window's first move.
void set_spins(const std::vector<double>& spins, std::size_t first, Program& window) {
  for (std::size_t m = 0; m < window.moves.size(); ++m) {
    Move& move = window.moves[m];
    if (!move.orientation) continue;
    MoveOrientation& orientation = *move.orientation;
    const std::size_t number = first + m;
    orientation.end_spin = spins[number];
    if (!all_known(move.known_start))
      orientation.start_spin = orientation.end_spin;
    else
      orientation.start_spin = move.starts_uncorrected || number == 0 ? 0 : spins[number - 1];
  }
}

void reset_spins(Program& window) {
  for (Move& move : window.moves)
    if (move.orientation) move.orientation->start_spin = move.orientation->end_spin = 0;
}

// Breaks of the force at each of a window's places. A log with more has smaller windows: 100,000 rows on 500
// moves took 260 MB.
constexpr std::size_t usual_breaks = 4;

// By what the size of the first window is divided: a log may have many rows on the first moves. With 16 the
// run above takes 35 MB.
std::size_t first_part(const ForceSource& source) {
  const auto is_log = [](const ForceRule& rule) {
    const auto* profile = std::get_if<ForceProfile>(&rule.content);
    return profile != nullptr && profile->key != ForceKey::line && profile->key != ForceKey::block_number;
  };
  return std::ranges::any_of(source.rules, is_log) ? 16 : 1;
}

// As far as the frame of the force needs them.
std::vector<Matrix3> orientations_for_forces(const RunInput& input, const Program& window,
                                             const Toolpath& path) {
  if (needs_tool_axes(input.source)) return tool_orientations(input, window, path);
  return {tip(input.model.mechanism, input.model.home).R};
}

}  // namespace

std::vector<Matrix3> tool_orientations(const RunInput& input, const Program& window, const Toolpath& path) {
  const Matrix3 R_home = tip(input.model.mechanism, input.model.home).R;
  if (path.segments.empty()) return {R_home};
  const std::vector<Matrix3> in_the_middle = sampled_orientations(input, window, path, 1);
  const bool turns = std::any_of(in_the_middle.begin(), in_the_middle.end(),
                                 [&](const Matrix3& R) { return (R - R_home).norm() > 1e-9; });
  return turns ? sampled_orientations(input, window, path, orientations_of_segment) : std::vector{R_home};
}

std::vector<Matrix3> tool_orientations_at_holes(const RunInput& input, const Program& window) {
  std::vector<TipPosition> places;
  for (const Move& move : window.moves) {
    if (!drills(move)) continue;
    const Pose X_MW = wanted_frame(input.frames[move.frame]);
    places.push_back({&model_with(input.model, input.tools, move.tool), X_MW * (hole_of(move) * mm), {}});
    if (move.orientation) places.back().R_MT = X_MW.R * orientation_at(turn_of(*move.orientation), 1);
  }
  return orientations_at(input, places);
}

JobWindows::JobWindows(const RunInput& input, ProgramReader& reader)
    : input_(input),
      reader_(reader),
      part_(first_part(input.source)),
      directions_{input.first_directions, {}} {}

// The forces are those of the program as it is: they do not turn with the flange.
void JobWindows::build(JobWindow& window) const {
  Program& program = reader_.window();
  ignore_axes(program, input_.ignored);
  if (input_.spins != nullptr) reset_spins(program);
  window.path = build_toolpath(program, input_.frames, path_end_);
  const std::vector<Matrix3> R_MT = orientations_for_forces(input_, program, window.path);
  const std::vector<Matrix3> at_holes =
      R_MT.size() > 1 ? tool_orientations_at_holes(input_, program) : std::vector<Matrix3>{};
  if (input_.spins != nullptr) {
    set_spins(*input_.spins, moves_, program);
    window.path = build_toolpath(program, input_.frames, path_end_);
  }
  window.forces.emplace(input_.source, program, window.path, R_MT, forces_, at_holes);
}

bool JobWindows::next(JobWindow& window) {
  if (!reader_.next(part_)) return false;
  build(window);
  while (!window.forces->is_final() && reader_.extend()) build(window);
  part_ = 1 + window.forces->count_of_breaks() /
                  (usual_breaks * std::max<std::size_t>(window_size(reader_.window()), 1));
  reader_.take_window(window.program);
  window.from = tip_;
  window.first_move = moves_;
  moves_ += window.program.moves.size();
  path_end_ = window.path.end;
  forces_ = window.forces->tail();
  window.directions = PathDirections{};
  window.directions = directions_along(job(window), directions_);
  if (window.path.segments.empty()) return true;
  const Segment& last = window.path.segments.back();
  tip_ = TipPosition{&model_of(job(window), last), last.wanted.end, orientation_at(last, 1)};
  return true;
}

Job JobWindows::job(const JobWindow& window) const {
  return {.model = input_.model,
          .program = window.program,
          .path = window.path,
          .forces = *window.forces,
          .options = input_.options,
          .read = input_.read,
          .tools = input_.tools,
          .starts = input_.starts,
          .from = window.from,
          .directions = has_reversals(input_.model) ? &window.directions : nullptr,
          .uncertainties = input_.uncertainties,
          .as_programmed = input_.as_programmed,
          .first_move = window.first_move};
}

// Without forces, which move no actuator of the nominal machine.
Directions first_directions(const RunInput& input, ProgramReader& reader) {
  const ForceSource none{.blend = 0};
  JobWindows windows({.model = input.model,
                      .frames = input.frames,
                      .ignored = input.ignored,
                      .source = none,
                      .options = input.options,
                      .read = input.read,
                      .tools = input.tools,
                      .starts = input.starts,
                      .first_directions = input.first_directions,
                      .spins = input.spins},
                     reader);
  Directions first = input.first_directions;
  const std::vector<double>& reversal = input.model.mechanism.reversal;
  const auto is_known = [&] {
    for (std::size_t a = 0; a < reversal.size(); ++a)
      if (reversal[a] > 0 && first.of(a) == 0) return false;
    return true;
  };
  JobWindow window;
  while (!is_known() && windows.next(window)) add_first_motions(window.directions, first);
  return first;
}

void for_each_window(ProgramReader& reader, int threads, const std::function<void(const Program&)>& first,
                     const std::function<void(const Program&)>& behind) {
  Program window;
  std::future<void> looking;  // `behind` looks at the window before
  while (reader.next()) {
    first(reader.window());
    if (looking.valid()) looking.get();
    reader.take_window(window);
    if (threads > 1)
      looking = std::async(std::launch::async, [&] { behind(window); });
    else
      behind(window);
  }
  if (looking.valid()) looking.get();
}

}  // namespace counterflex
