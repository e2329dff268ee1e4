#include "counterflex/statics/skeleton.hpp"

#include "counterflex/statics/nominal.hpp"
#include "statics/model/part.hpp"

namespace counterflex {
namespace {

bool moves_origin(const Part& part) {
  switch (part.kind) {
    case PartKind::fixed:
      return !part.X.p.isZero(0);
    case PartKind::actuator:
    case PartKind::passive:
      return part.joint.kind == JointKind::prismatic;
    default:
      return false;
  }
}

void add_line(SkeletonLine line, std::vector<SkeletonLine>& lines) {
  if (line.size() > 1) lines.push_back(std::move(line));
}

// Adds the lines of a series that starts at `X_MS`, but its last line, which it returns. `beside_others`: of
// series side by side on the base the fixed elements on the base are not drawn.
SkeletonLine add_series(const Series& series, const SeriesState& state, const Pose& X_MS, bool beside_others,
                        std::vector<SkeletonLine>& lines) {
  Pose X = X_MS;
  SkeletonLine line{X.p};
  bool on_base = true;
  for (const Part& part : series.parts) {
    if (part.kind == PartKind::mass) continue;
    if (part.kind == PartKind::group) {
      add_line(std::move(line), lines);
      const auto& branches = series.groups[static_cast<std::size_t>(part.group)].branches;
      const auto& states = state.groups[static_cast<std::size_t>(part.group)].branches;
      for (std::size_t b = 0; b < branches.size(); ++b)
        add_line(add_series(branches[b], states[b], X, on_base, lines), lines);
    }
    X = X * part_pose(part, state, nominal_stage);
    on_base = on_base && part.column < 0;
    if (part.kind == PartKind::group || (beside_others && on_base))
      line = {X.p};
    else if (moves_origin(part))
      line.push_back(X.p);
  }
  return line;
}

}  // namespace

std::vector<SkeletonLine> skeleton(const Mechanism& mechanism, const Configuration& nominal) {
  std::vector<SkeletonLine> lines;
  SkeletonLine last{nominal.X_MP.p};
  for (std::size_t i = 0; i < mechanism.chains.size(); ++i) {
    SkeletonLine line =
        add_series(mechanism.chains[i], nominal.chains[i], {Matrix3::Identity(), Vector3::Zero()},
                   mechanism.chains.size() > 1, lines);
    if (mechanism.chains.size() == 1)
      last = std::move(line);
    else
      add_line(std::move(line), lines);
  }
  if (!mechanism.X_PT.p.isZero(0)) last.push_back(tip(mechanism, nominal).p);
  add_line(std::move(last), lines);
  return lines;
}

}  // namespace counterflex
