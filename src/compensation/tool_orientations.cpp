#include "tool_orientations.hpp"

#include <algorithm>

namespace counterflex {
namespace {

constexpr int orientations_of_segment = 9;

// At equal fractions of every segment, or in its middle.
std::vector<Matrix3> sampled_orientations(const RunInput& input, const Program& window, const Toolpath& path,
                                          int each, NominalPlace& place) {
  std::vector<Matrix3> R_MT;
  NominalToolPath nominal(place);
  for (const Segment& segment : path.segments) {
    const Model& model = model_with(input.model, input.tools, window.moves[segment.move].tool);
    for (int k = 0; k < each; ++k) {
      const double u = each == 1 ? 0.5 : static_cast<double>(k) / (each - 1);
      nominal.go_to(model, point_at(segment.wanted, u));  // a failure is said where it is solved
      R_MT.push_back(nominal.orientation());
    }
  }
  place = nominal.place();
  return R_MT;
}

}  // namespace

std::vector<Matrix3> tool_orientations(const RunInput& input, const Program& window, const Toolpath& path,
                                       NominalPlace& nominal) {
  const Matrix3 R_home = tip(input.model.mechanism, input.model.home).R;
  if (!needs_tool_axes(input.source) || path.segments.empty()) return {R_home};
  NominalPlace start = nominal;
  const std::vector<Matrix3> in_the_middle = sampled_orientations(input, window, path, 1, nominal);
  const bool turns = std::any_of(in_the_middle.begin(), in_the_middle.end(),
                                 [&](const Matrix3& R) { return (R - R_home).norm() > 1e-9; });
  return turns ? sampled_orientations(input, window, path, orientations_of_segment, start)
               : std::vector{R_home};
}

}  // namespace counterflex
