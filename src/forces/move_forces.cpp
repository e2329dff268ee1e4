#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "counterflex/forces/forces.hpp"
#include "forces/path/raw_forces.hpp"
#include "forces/turning_axes.hpp"

namespace counterflex {
namespace {

constexpr double middle_of_move = 0.5;

// Relative change along a piece that still counts as constant. Pieces of a turning wrench are linear to half
// of this.
constexpr double same_wrench = 2e-4;

// Wrenches of two pieces closer than this are one step.
constexpr double same_step = 1e-9;

// A piece shorter than this (m) is a flip of the feed frame between two others.
constexpr double shortest_part = 2e-7;

// Fractions of a piece at which it is tested for being constant. No number of turns of a helix returns to the
// same axes at all of them.
constexpr std::array tested{0.0, 0.1458980337503154, 0.3819660112501051, 0.5, 1.0};

// Parts per piece of turning axes in which torques are computed; they are even if they change by less than
// this along the move.
constexpr int parts_per_piece = 4;
constexpr double even_torque = 0.01;

bool has_models(const ForceSource& source) {
  return std::any_of(source.rules.begin(), source.rules.end(),
                     [](const ForceRule& rule) { return std::holds_alternative<CutResponse>(rule.content); });
}

/// The rule whose model acts in the middle of a move, or null.
const ForceRule* model_of(const std::vector<ForceStretch>& stretches) {
  const auto at = std::find_if(stretches.begin(), stretches.end(),
                               [](const ForceStretch& stretch) { return stretch.to > middle_of_move; });
  if (at == stretches.end() || at->rule == nullptr) return nullptr;
  return std::holds_alternative<CutResponse>(at->rule->content) ? at->rule : nullptr;
}

/// In the middle of the move, whose pieces these are.
Vector6 value_in_the_middle(const std::vector<ForcePiece>& pieces, const Segment& segment) {
  const double s = (segment.s_start + segment.s_end) / 2;
  const auto at =
      std::find_if(pieces.begin(), pieces.end(), [s](const ForcePiece& piece) { return piece.s1 > s; });
  const ForcePiece& piece = at == pieces.end() ? pieces.back() : *at;
  return value(piece, std::clamp(s, piece.s0, piece.s1));
}

/// The part of F, in machine axes, that the feed frame can represent. Sets `lost` if there is another part.
Vector6 in_feed_frame(const Vector6& F, const ForceAxes& axes, bool& lost) {
  Vector6 all;
  all << axes.R_MF.transpose() * F.head<3>(), axes.R_MF.transpose() * F.tail<3>();
  if (!axes.only_z) return all;
  Vector6 representable = all;
  for (const int i : {0, 1, 3, 4}) representable[i] = 0;
  lost = lost || (all - representable).norm() > same_wrench * all.norm();
  return representable;
}

/// Adds a step with a constant wrench from s on, unless it equals the previous step.
void add_step(double s, const Vector6& F, std::vector<ForceStep>& steps) {
  if (steps.empty() || (steps.back().F - F).norm() > same_step * F.norm()) steps.push_back({s, F});
}

std::optional<CutTorque> torque_of(const CutForce& force) {
  if (!force.why.empty()) return std::nullopt;
  return CutTorque{force.chip_torque, force.F[5] - force.chip_torque};
}

/// Whether all torques are nearly the same, or none acts.
bool are_even(const std::vector<std::optional<CutTorque>>& torques) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const std::optional<CutTorque>& torque : torques) {
    if (torque.has_value() != torques.front().has_value()) return false;
    if (!torque) continue;
    least = std::min(least, torque->chip + torque->edge);
    most = std::max(most, torque->chip + torque->edge);
  }
  return !torques.front() || most - least <= even_torque * std::abs(most);
}

/// The moves of one window, in order.
class MoveForces {
 public:
  MoveForces(const ForceSource& source, const Program& window, const Toolpath& path,
             const std::vector<Matrix3>& R_MT, std::optional<long>& block_number)
      : source_(source), window_(window), path_(path), R_MT_(R_MT) {
    std::optional<long> n = block_number;
    if (has_models(source)) coverage_.emplace(source, window, path, n);
    raw_forces_.emplace(source, window, path, R_MT, block_number);
  }

  MoveForce of(std::size_t i) {
    const Segment& segment = path_.segments[i];
    const Move& move = window_.moves[segment.move];
    MoveForce result{segment.line,     move.tool,       segment.s_start, segment.s_end - segment.s_start,
                     segment.feed_m_s, move.spindle_rpm};
    pieces_.clear();
    ForceRemarks remarks;
    raw_forces_->append_to(i, 0, 0, pieces_, remarks);
    if (!remarks.unforced.empty()) result.why = remarks.unforced.front().why;
    result.comment = move.force.has_value();
    result.comment_altered =
        result.comment && !move.force->isZero(0) && (source_.scale != 1 || in_air(source_, move));
    const Segment along = with_force_end(segment);
    const AxesAlong axes = axes_of_feed(i, along);
    take_wrenches(axes, along, result);
    if (coverage_ && !in_air(source_, move)) take_model(i, axes, result);
    return result;
  }

 private:
  AxesAlong axes_of_feed(std::size_t i, const Segment& segment) const {
    const std::size_t each = R_MT_.size() == 1 ? 1 : R_MT_.size() / path_.segments.size();
    const std::span<const Matrix3> R_MT(R_MT_.data() + (R_MT_.size() == 1 ? 0 : i * each), each);
    return {ForceFrame::feed, segment, path_.frames[segment.frame].X_MW.R, R_MT};
  }

  /// Sets the steps of a move whose wrench is piecewise constant. Its wrench is that of the only step, else
  /// that in the middle.
  void take_wrenches(const AxesAlong& axes, const Segment& segment, MoveForce& result) const {
    bool constant = true;
    for (const ForcePiece& piece : pieces_) {
      result.largest_N = std::max({result.largest_N, piece.F0.head<3>().norm(), piece.F1.head<3>().norm()});
      if (pieces_.size() > 1 && piece.s1 - piece.s0 < shortest_part) continue;
      const double s = result.steps.empty() ? segment.s_start : piece.s0;
      if (const auto F = constant_along(piece, axes, segment, result.only_z))
        add_step(s, *F, result.steps);
      else
        constant = false;
    }
    if (!constant) result.steps.clear();
    result.changes = result.steps.size() != 1;
    result.F = result.changes ? in_feed_frame(value_in_the_middle(pieces_, segment),
                                              axes.at(middle_of_move, 1), result.only_z)
                              : result.steps.front().F;
  }

  /// The wrench of a piece in the feed frame, if it is constant.
  static std::optional<Vector6> constant_along(const ForcePiece& piece, const AxesAlong& axes,
                                               const Segment& segment, bool& lost) {
    const auto at = [&](double w) {
      const double s = piece.s0 + w * (piece.s1 - piece.s0);
      const double u = (s - segment.s_start) / (segment.s_end - segment.s_start);
      return in_feed_frame(piece.F0 + w * (piece.F1 - piece.F0), axes.at(u, w < 1 ? 1 : -1), lost);
    };
    const Vector6 F = (at(0) + at(1)) / 2;
    const auto same = [&](double w) { return (at(w) - F).norm() <= same_wrench * F.norm(); };
    if (std::all_of(tested.begin(), tested.end(), same)) return F;
    return std::nullopt;
  }

  void take_model(std::size_t i, const AxesAlong& axes, MoveForce& result) {
    const ForceRule* rule = model_of(coverage_->stretches(i));
    if (rule == nullptr) return;
    const auto* response = std::get_if<CutResponse>(&rule->content);
    const Segment& segment = path_.segments[i];
    const double rpm = result.spindle_rpm;
    const auto force = [&](double u) {
      const double slope = direction_at(segment.wanted, u).dot(axes.at(u, 1).R_MF.col(2));
      return cutting_force(*response, segment.feed_m_s, rpm, slope);
    };
    const CutForce middle = force(middle_of_move);
    result.feed_per_tooth = middle.feed_per_tooth;
    result.model = rule;
    if (response->spindle_rpm > 0) result.spindle_rpm = response->spindle_rpm;
    const int parts = axes.turn() ? parts_per_piece * axes.pieces() : 1;
    for (int k = 0; k < parts; ++k) result.torques.push_back(torque_of(force((k + 0.5) / parts)));
    if (are_even(result.torques)) result.torques = {torque_of(middle)};
  }

  const ForceSource& source_;
  const Program& window_;
  const Toolpath& path_;
  const std::vector<Matrix3>& R_MT_;
  std::optional<Coverage> coverage_;
  std::optional<RawForces> raw_forces_;
  std::vector<ForcePiece> pieces_;
};

MoveForce unplaced(const Move& move, std::string why) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  MoveForce result{.line = move.line, .tool = move.tool, .s_start = unknown, .length = unknown};
  if (move.feed_mode == FeedMode::length) result.feed_m_s = move.feed_mm_min * mm / 60;
  result.spindle_rpm = move.spindle_rpm;
  result.why = std::move(why);
  return result;
}

}  // namespace

std::vector<MoveForce> move_forces(const ForceSource& source, const Program& window, const Toolpath& path,
                                   const std::vector<Matrix3>& R_MT, std::optional<long>& block_number) {
  std::vector<MoveForce> moves;
  std::size_t next = 0;
  const auto add_unplaced_to = [&](std::size_t end) {
    for (; next < end; ++next)
      if (std::string why = why_unplaced(window, path, next); !why.empty())
        moves.push_back(unplaced(window.moves[next], std::move(why)));
  };
  if (path.segments.empty()) {
    RawForces(source, window, path, R_MT, block_number);
    add_unplaced_to(window.moves.size());
    return moves;
  }
  MoveForces forces(source, window, path, R_MT, block_number);
  for (std::size_t i = 0; i < path.segments.size(); ++i) {
    add_unplaced_to(path.segments[i].move);
    if (path.segments[i].cutting) moves.push_back(forces.of(i));
  }
  add_unplaced_to(window.moves.size());
  return moves;
}

}  // namespace counterflex
