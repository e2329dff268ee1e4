#include "tool_orientations.hpp"

#include <algorithm>

namespace counterflex {
namespace {

constexpr int orientations_of_segment = 9;

// At equal fractions of every segment, or in its middle.
std::vector<Matrix3> sampled_orientations(const Model& model, const Toolpath& path, int each,
                                          Configuration& configuration) {
  const Matrix3 R_home = tip(model.mechanism, model.home).R;
  std::vector<Matrix3> R_MT;
  NominalPath nominal(model, configuration);
  for (const Segment& segment : path.segments)
    for (int k = 0; k < each; ++k) {
      const double u = each == 1 ? 0.5 : static_cast<double>(k) / (each - 1);
      nominal.go_to({R_home, point_at(segment.wanted, u)});  // a failure is said where it is solved
      R_MT.push_back(tip(model.mechanism, nominal.configuration()).R);
    }
  configuration = nominal.configuration();
  return R_MT;
}

}  // namespace

std::vector<Matrix3> tool_orientations(const Model& model, const Toolpath& path, const ForceSource& source,
                                       Configuration& nominal) {
  const Matrix3 R_home = tip(model.mechanism, model.home).R;
  if (!needs_tool_axes(source) || path.segments.empty()) return {R_home};
  Configuration start = nominal;
  const std::vector<Matrix3> in_the_middle = sampled_orientations(model, path, 1, nominal);
  const bool turns = std::any_of(in_the_middle.begin(), in_the_middle.end(),
                                 [&](const Matrix3& R) { return (R - R_home).norm() > 1e-9; });
  return turns ? sampled_orientations(model, path, orientations_of_segment, start) : std::vector{R_home};
}

}  // namespace counterflex
