#include "forces/turning_axes.hpp"

#include <algorithm>

#include "counterflex/geometry/pose.hpp"

namespace counterflex {
namespace {

// Largest relative error of a linear piece of a turning wrench.
constexpr double linear_to = 1e-4;

// Turns of the feed between two pieces below this are ignored: tangents of arcs with 3 decimals are not more
// accurate.
constexpr double same_tangent = 1e-3;

// Pieces of a turning wrench are not halved below this length (m): a remaining difference is a step.
constexpr double shortest_turn = 1e-7;

// Distance, as a fraction of an arc, from a place where the feed is parallel to the tool.
constexpr double beside = 1e-4;

// Initial pieces turn by at most this (rad), so that the error in the middle shows their curvature.
constexpr double widest_turn = 0.5;

/// The wrench along `piece` before and after axes are applied; `s` is a place on it.
class Turning {
 public:
  Turning(const ForcePiece& piece, const Segment& segment, const AxesAlong& axes)
      : piece_(piece), segment_(segment), axes_(axes) {}

  Vector6 after(double s) const { return at(s, 1); }
  Vector6 before(double s) const { return at(s, -1); }

  /// Appends linear pieces over [s0, s1].
  void halve(double s0, double s1, std::vector<ForcePiece>& pieces) const {
    const double middle = (s0 + s1) / 2;
    const Vector6 F0 = after(s0), F1 = before(s1);
    const double size = std::max(F0.norm(), F1.norm());
    const double off =
        std::max((before(middle) - (F0 + F1) / 2).norm(), (after(middle) - (F0 + F1) / 2).norm());
    if (off <= linear_to * size) return add(s0, s1, F0, F1, pieces);
    if (s1 - s0 > 2 * shortest_turn) {
      halve(s0, middle, pieces);
      return halve(middle, s1, pieces);
    }
    add(s0, middle, F0, F0, pieces);
    add(middle, s1, F1, F1, pieces);
  }

 private:
  Vector6 at(double s, double towards) const {
    const double u = (s - segment_.s_start) / (segment_.s_end - segment_.s_start);
    const double w = std::clamp((s - piece_.s0) / (piece_.s1 - piece_.s0), 0.0, 1.0);
    return in_machine_axes(axes_.at(u, towards), (1 - w) * piece_.F0 + w * piece_.F1);
  }

  static void add(double s0, double s1, const Vector6& F0, const Vector6& F1,
                  std::vector<ForcePiece>& pieces) {
    const bool goes_on = !pieces.empty() && nearly_same(pieces.back().F1, F0);
    pieces.push_back({s0, s1, F0, F1, Vector6::Zero(), goes_on});
  }

  const ForcePiece& piece_;
  const Segment& segment_;
  const AxesAlong& axes_;
};

}  // namespace

bool nearly_same(const Vector6& A, const Vector6& B) {
  return (A - B).norm() <= same_tangent * std::max(A.norm(), B.norm());
}

bool AxesAlong::turn() const {
  const bool of_tool = frame_ == ForceFrame::tool || frame_ == ForceFrame::feed;
  return of_tool && (R_MT_.size() > 1 || (frame_ == ForceFrame::feed && segment_.wanted.arc));
}

int AxesAlong::pieces() const {
  const int of_arc = segment_.wanted.arc ? 1 + static_cast<int>(segment_.wanted.arc->sweep / widest_turn) : 1;
  return std::max(of_arc, static_cast<int>(R_MT_.size()) - 1);
}

Matrix3 AxesAlong::tool_at(double fraction) const {
  if (R_MT_.size() == 1) return R_MT_[0];
  const double place = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(R_MT_.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), R_MT_.size() - 2);
  const Vector3 turn = log_so3(R_MT_[i].transpose() * R_MT_[i + 1]);
  return R_MT_[i] * exp_so3((place - static_cast<double>(i)) * turn);
}

ForceAxes AxesAlong::at(double fraction, double towards) const {
  if (frame_ == ForceFrame::machine) return {};
  if (frame_ == ForceFrame::work) return {R_MW_, false};
  const Matrix3 R_MT = tool_at(fraction);
  const ForceAxes axes = axes_of(frame_, direction_at(segment_.wanted, fraction), R_MW_, R_MT);
  if (!segment_.wanted.arc || !axes.only_z) return axes;
  return axes_of(frame_, direction_at(segment_.wanted, fraction + beside * towards), R_MW_, R_MT);
}

void turn_pieces(const ForcePiece& piece, const Segment& segment, const AxesAlong& axes,
                 std::vector<ForcePiece>& pieces) {
  const Turning turning(piece, segment, axes);
  pieces.clear();
  if (axes.are_of_machine()) {
    const Vector6 none = Vector6::Zero();  // adding it removes signs of zeros
    pieces.push_back({piece.s0, piece.s1, piece.F0 + none, piece.F1 + none, none});
    return;
  }
  if (!axes.turn()) {
    pieces.push_back(
        {piece.s0, piece.s1, turning.after(piece.s0), turning.before(piece.s1), Vector6::Zero()});
    return;
  }
  const double part = (piece.s1 - piece.s0) / (segment.s_end - segment.s_start);
  const int count = 1 + static_cast<int>(part * axes.pieces());
  const auto limit = [&](int i) {
    return i == count ? piece.s1 : piece.s0 + (piece.s1 - piece.s0) * i / count;
  };
  for (int i = 0; i < count; ++i) turning.halve(limit(i), limit(i + 1), pieces);
}

}  // namespace counterflex
