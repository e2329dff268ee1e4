#include "forces/unblended.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>

#include "forces/turned.hpp"

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

bool lateral(const Vector6& F) {
  return F[0] != 0 || F[1] != 0 || F[3] != 0 || F[4] != 0;
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

Unblended::Unblended(const ForceSource& source, const Program& program, const Toolpath& path,
                     const std::vector<Matrix3>& R_MT, std::optional<long>& block_number)
    : source_(source), program_(program), path_(path), R_MT_(R_MT) {
  assert(R_MT.size() == 1 || (!R_MT.empty() && R_MT.size() % path.segments.size() == 0));
  if (profile()) keys_ = align(*profile(), program, path, block_number);
}

void Unblended::append_to(std::size_t i, std::size_t first_piece, std::vector<ForcePiece>& pieces,
                          std::vector<ForceNote>& notes) const {
  const Segment& segment = path_.segments[i];
  if (in_air(segment)) {
    append({segment.s_start, segment.s_end}, first_piece, pieces);
    return;
  }
  if (!profile()) {
    const Vector6 F = source_.scale * uniform(segment);
    append({segment.s_start, segment.s_end, F, F, Vector6::Zero()}, first_piece, pieces);
    return;
  }
  const AxesAlong axes(profile()->frame, segment, path_.frames[segment.frame].X_MW.R, orientations(i));
  const bool only_z = axes.at(0.5, 1).only_z;
  bool lost = false, inside = false;
  for (const ForcePiece& given : profile_pieces(*profile(), keys_[i], segment)) {
    lost = lost || (only_z && (lateral(given.F0) || lateral(given.F1)));
    for (ForcePiece piece : turned_pieces(given, segment, axes)) {
      piece.F0 *= source_.scale;
      piece.F1 *= source_.scale;
      if (!inside) piece.goes_on = goes_on_round(piece, first_piece, pieces);
      inside = true;
      append(piece, first_piece, pieces);
    }
  }
  if (lost)
    notes.push_back({segment.line,
                     "the feed is parallel to the tool axis: of the force in the feed frame only the z "
                     "component acts"});
}

const ForceProfile* Unblended::profile() const {
  return !source_.constant && source_.profile ? &*source_.profile : nullptr;
}

std::span<const Matrix3> Unblended::orientations(std::size_t i) const {
  if (R_MT_.size() == 1) return R_MT_;
  const std::size_t each = R_MT_.size() / path_.segments.size();
  return std::span(R_MT_).subspan(i * each, each);
}

bool Unblended::in_air(const Segment& segment) const {
  return source_.air_above_mm && extent_of(program_.moves[segment.move]).least.z() > *source_.air_above_mm;
}

/// Whether the first piece of a segment continues a wrench in axes that turn, as round a tangential
/// junction.
bool Unblended::goes_on_round(const ForcePiece& piece, std::size_t first_piece,
                              const std::vector<ForcePiece>& pieces) const {
  const bool turns = profile()->frame == ForceFrame::feed || profile()->frame == ForceFrame::tool;
  return turns && pieces.size() > first_piece && nearly_same(pieces.back().F1, piece.F0);
}

/// The constant, or what the program's comment says.
Vector6 Unblended::uniform(const Segment& segment) const {
  if (source_.constant) return *source_.constant;
  return program_.moves[segment.move].force.value_or(Vector6::Zero());
}

}  // namespace counterflex
