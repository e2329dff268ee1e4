#include "counterflex/forces/move_forces.hpp"

#include <algorithm>
#include <span>

#include "forces/turned.hpp"
#include "forces/unblended.hpp"

namespace counterflex {
namespace {

constexpr double middle = 0.5;

bool has_models(const ForceSource& source) {
  return std::any_of(source.rules.begin(), source.rules.end(),
                     [](const ForceRule& rule) { return std::holds_alternative<CutResponse>(rule.content); });
}

/// The model that acts in the middle of a move, or null.
const CutResponse* model_of(const std::vector<Stretch>& stretches) {
  const auto at = std::find_if(stretches.begin(), stretches.end(),
                               [](const Stretch& stretch) { return stretch.to > middle; });
  if (at == stretches.end() || at->rule == nullptr) return nullptr;
  return std::get_if<CutResponse>(&at->rule->content);
}

/// In the middle of the move, whose pieces these are.
Vector6 value_in_the_middle(const std::vector<ForcePiece>& pieces, const Segment& segment) {
  const double s = (segment.s_start + segment.s_end) / 2;
  const auto at =
      std::find_if(pieces.begin(), pieces.end(), [s](const ForcePiece& piece) { return piece.s1 > s; });
  const ForcePiece& piece = at == pieces.end() ? pieces.back() : *at;
  return value(piece, std::clamp(s, piece.s0, piece.s1));
}

/// Of F, in machine axes, what the feed frame can say.
void take_wrench(const Vector6& F, const ForceAxes& axes, MoveForce& move) {
  move.F << axes.R_MF.transpose() * F.head<3>(), axes.R_MF.transpose() * F.tail<3>();
  if (!axes.only_z) return;
  const Vector6 all = move.F;
  for (const int i : {0, 1, 3, 4}) move.F[i] = 0;
  move.only_z = (all - move.F).norm() > 1e-9 * all.norm();
}

/// The moves of one window, one after the other.
class MoveForces {
 public:
  MoveForces(const ForceSource& source, const Program& window, const Toolpath& path,
             const std::vector<Matrix3>& R_MT, std::optional<long>& block_number)
      : source_(source), window_(window), path_(path), R_MT_(R_MT) {
    std::optional<long> n = block_number;
    if (has_models(source)) coverage_.emplace(source, window, path, n);
    unblended_.emplace(source, window, path, R_MT, block_number);
  }

  MoveForce of(std::size_t i) {
    const Segment& segment = path_.segments[i];
    const Move& move = window_.moves[segment.move];
    MoveForce result{segment.line,     move.tool,       segment.s_start, segment.s_end - segment.s_start,
                     segment.feed_m_s, move.spindle_rpm};
    pieces_.clear();
    ForceRemarks remarks;
    unblended_->append_to(i, 0, pieces_, remarks);
    const ForceAxes axes = axes_of_feed(i);
    if (remarks.unforced.empty())
      take_wrench(value_in_the_middle(pieces_, segment), axes, result);
    else
      result.why = remarks.unforced.front().why;
    if (coverage_ && !in_air(source_, move)) take_model(i, axes, result);
    return result;
  }

 private:
  ForceAxes axes_of_feed(std::size_t i) const {
    const Segment& segment = path_.segments[i];
    const std::size_t each = R_MT_.size() == 1 ? 1 : R_MT_.size() / path_.segments.size();
    const std::span<const Matrix3> R_MT(R_MT_.data() + (R_MT_.size() == 1 ? 0 : i * each), each);
    return AxesAlong(ForceFrame::feed, segment, path_.frames[segment.frame].X_MW.R, R_MT).at(middle, 1);
  }

  void take_model(std::size_t i, const ForceAxes& axes, MoveForce& result) {
    const CutResponse* response = model_of(coverage_->stretches(i));
    if (response == nullptr) return;
    const Segment& segment = path_.segments[i];
    const double slope = direction_at(segment.wanted, middle).dot(axes.R_MF.col(2));
    const CutForce force = cutting_force(*response, segment.feed_m_s, result.spindle_rpm, slope);
    result.feed_per_tooth = force.feed_per_tooth;
    if (response->spindle_rpm > 0) result.spindle_rpm = response->spindle_rpm;
  }

  const ForceSource& source_;
  const Program& window_;
  const Toolpath& path_;
  const std::vector<Matrix3>& R_MT_;
  std::optional<Coverage> coverage_;
  std::optional<Unblended> unblended_;
  std::vector<ForcePiece> pieces_;
};

}  // namespace

std::vector<MoveForce> move_forces(const ForceSource& source, const Program& window, const Toolpath& path,
                                   const std::vector<Matrix3>& R_MT, std::optional<long>& block_number) {
  std::vector<MoveForce> moves;
  if (path.segments.empty()) {
    Unblended(source, window, path, R_MT, block_number);
    return moves;
  }
  MoveForces forces(source, window, path, R_MT, block_number);
  for (std::size_t i = 0; i < path.segments.size(); ++i)
    if (path.segments[i].cutting) moves.push_back(forces.of(i));
  return moves;
}

}  // namespace counterflex
