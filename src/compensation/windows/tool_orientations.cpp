#include "counterflex/compensation/tool_orientations.hpp"

#include <algorithm>

#include "compensation/plan/places.hpp"
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

}  // namespace counterflex
