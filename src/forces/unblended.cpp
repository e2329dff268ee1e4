#include "forces/unblended.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace counterflex {
namespace {

// Sine of the angle between feed and tool below which the feed has no lateral direction. A direction made of
// rounded coordinates carries more noise than that.
constexpr double parallel = 1e-6;

// Keys closer than this to the end of a segment act at the end (m).
constexpr double shortest_piece = 1e-9;

/// The row that holds at `key`: the last one that is not beyond it.
std::size_t row_at(const ForceProfile& profile, double key) {
  const auto& rows = profile.rows;
  const auto beyond = std::upper_bound(rows.begin(), rows.end(), key,
                                       [](double value, const ForceRow& row) { return value < row.key; });
  return beyond == rows.begin() ? 0 : static_cast<std::size_t>(beyond - rows.begin()) - 1;
}

/// The profile at `key`, which lies in the interval that begins with `row`.
Vector6 value(const ForceProfile& profile, std::size_t row, double key) {
  const ForceRow& from = profile.rows[row];
  if (!profile.linear || row + 1 == profile.rows.size()) return from.F;
  const ForceRow& to = profile.rows[row + 1];
  const double w = std::clamp((key - from.key) / (to.key - from.key), 0.0, 1.0);
  return (1 - w) * from.F + w * to.F;
}

}  // namespace

ForceAxes feed_axes(const Vector3& feed_M, const Matrix3& R_MT) {
  const Vector3 z = R_MT.col(2), lateral = z.cross(feed_M.normalized());
  ForceAxes axes;
  if (lateral.norm() < parallel) return {R_MT, true};
  axes.R_MF.col(1) = lateral.normalized();
  axes.R_MF.col(0) = axes.R_MF.col(1).cross(z);
  axes.R_MF.col(2) = z;
  return axes;
}

ForceAxes axes_of(ForceFrame frame, const Vector3& feed_M, const Matrix3& R_MW, const Matrix3& R_MT) {
  switch (frame) {
    case ForceFrame::machine:
      return {};
    case ForceFrame::work:
      return {R_MW, false};
    case ForceFrame::tool:
      return {R_MT, false};
    case ForceFrame::feed:
      break;
  }
  return feed_axes(feed_M, R_MT);
}

Vector6 in_machine_axes(const ForceAxes& axes, const Vector6& F) {
  Vector6 F_M = F;
  if (axes.only_z) F_M[0] = F_M[1] = F_M[3] = F_M[4] = 0;
  F_M.head<3>() = (axes.R_MF * F_M.head<3>()).eval();
  F_M.tail<3>() = (axes.R_MF * F_M.tail<3>()).eval();
  return F_M;
}

std::vector<ForcePiece> profile_pieces(const ForceProfile& profile, const KeySpan& keys,
                                       const Segment& segment) {
  const double length = segment.s_end - segment.s_start, range = keys.end - keys.start;
  const double margin = range * std::min(shortest_piece / length, 0.5);
  std::vector<ForcePiece> pieces;
  const auto add = [&](double from, double to, double s0, double s1) {
    const std::size_t row = row_at(profile, (from + to) / 2);
    pieces.push_back({s0, s1, value(profile, row, from), value(profile, row, to), Vector6::Zero()});
  };
  double from = keys.start, s0 = segment.s_start;
  for (std::size_t row = row_at(profile, keys.start); row < profile.rows.size(); ++row) {
    const double key = profile.rows[row].key;
    if (key <= keys.start + margin) continue;
    if (key >= keys.end - margin) break;
    const double s = segment.s_start + (key - keys.start) / range * length;
    add(from, key, s0, s);
    from = key;
    s0 = s;
  }
  add(from, keys.end, s0, segment.s_end);
  return pieces;
}

void append(const ForcePiece& piece, std::size_t first, std::vector<ForcePiece>& pieces) {
  if (pieces.size() > first) {
    ForcePiece& last = pieces.back();
    if (last.F0 == last.F1 && piece.F0 == piece.F1 && last.F1 == piece.F0) {
      last.s1 = piece.s1;
      return;
    }
  }
  pieces.push_back(piece);
}

}  // namespace counterflex
