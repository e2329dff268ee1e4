#pragma once
/// The wrench as given by rules and profiles, before the mean over the blend length.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "counterflex/forces/forces.hpp"
#include "forces/path/rules/coverage.hpp"

namespace counterflex {

class AxesAlong;

/// The path length at which a segment ends for the force (m). A segment that only turns the tool counts a
/// millimetre for each degree, as controls count its feed.
double force_end(const Segment& segment);

/// The segment with `force_end` for its end.
Segment with_force_end(const Segment& segment);

/// The axes in which a force is given, in the machine frame.
struct ForceAxes {
  Matrix3 R_MF = Matrix3::Identity();
  bool only_z = false;  ///< the feed is parallel to the tool, or it only turns: no lateral direction
};

/// Axes x, y, z of the feed frame: z the tool's, y = unit(z x feed), x = y x z.
ForceAxes feed_axes(const Vector3& feed_M, const Matrix3& R_MT);

/// The axes of `frame` where the tool moves along `feed_M`.
ForceAxes axes_of(ForceFrame frame, const Vector3& feed_M, const Matrix3& R_MW, const Matrix3& R_MT);

/// F in machine axes.
Vector6 in_machine_axes(const ForceAxes& axes, const Vector6& F);

/// Appends the linear pieces of the profile over keys, in the profile's frame, for path lengths [s0, s1].
void append_profile_pieces(const ForceProfile& profile, const KeySpan& keys, double s0, double s1,
                           std::vector<ForcePiece>& pieces);

/// Slope of the wrench along a piece (N/m, N), and its value at path length s.
inline Vector6 slope(const ForcePiece& piece) {
  return (piece.F1 - piece.F0) / (piece.s1 - piece.s0);
}
inline Vector6 value(const ForcePiece& piece, double s) {
  if (piece.is_constant) return piece.F0 + Vector6::Zero();  // removes signs of zeros
  return piece.F0 + (s - piece.s0) * slope(piece);
}

/// Appends `piece` to the pieces of a run that begin at `first`, or extends the last one if it has the same
/// constant.
void append(const ForcePiece& piece, std::size_t first, std::vector<ForcePiece>& pieces);

/// Why no force is computed for a feed move that is not part of `path`: "the position in XY is unknown".
/// Empty for other moves. `move` is an index into the moves of `program`.
std::string why_unplaced(const Program& program, const Toolpath& path, std::size_t move);

/// Notes on the forces of a window.
struct ForceRemarks {
  std::vector<ForceNote> notes;
  std::vector<Unforced> unforced;
};

/// The wrench of consecutive segments in machine axes.
class RawForces {
 public:
  /// Keeps references to all arguments. `R_MT` as for `PathForces`; `block_number` is N of the previous
  /// moves, then of these.
  RawForces(const ForceSource& source, const Program& program, const Toolpath& path,
            const std::vector<Matrix3>& R_MT, std::optional<long>& block_number);

  /// Appends the pieces of cutting segment i to those of its run, which begin at `first_piece`: to its
  /// `force_end`, and `shift` further along the run. Notes a plunge that loses lateral forces. Lists a move
  /// without a force.
  void append_to(std::size_t i, double shift, std::size_t first_piece, std::vector<ForcePiece>& pieces,
                 ForceRemarks& remarks);

  /// The wrench at the bottom of the hole of a move that `drills`, whose tool has the orientation `R_MT`:
  /// that of a plunge. Notes and lists it as `append_to` does a move.
  Vector6 in_hole(std::size_t move, const Matrix3& R_MT, ForceRemarks& remarks);

 private:
  /// The force of a stretch in its own frame, or the reason why it has none.
  struct StretchForce {
    std::vector<ForcePiece> pieces{};
    ForceFrame frame = ForceFrame::machine;
    std::string why{};  ///< empty if a force is given (it may be zero)
  };
  /// The force in a hole in its own frame, or the reason why it has none.
  struct GivenForce {
    Vector6 F = Vector6::Zero();
    ForceFrame frame = ForceFrame::machine;
    std::string why{};
  };
  /// `segment` is segment i with its `force_end`.
  void append_along(const Segment& segment, std::size_t i, double shift, std::size_t first_piece,
                    std::vector<ForcePiece>& pieces, ForceRemarks& remarks);
  GivenForce given_in_hole(const Move& move, const ForceStretch& by, double slope) const;
  void give(const ForceStretch& stretch, std::size_t i, const Segment& segment, const AxesAlong& axes);
  void give_same(double s0, double s1, const Vector6& F, ForceFrame frame);
  void give_cut(const CutResponse& response, double s0, double s1, const Segment& segment,
                const AxesAlong& axes);
  bool is_zero(const StretchForce& given) const;
  std::span<const Matrix3> orientations(std::size_t i) const;  ///< of the tool on segment i
  void append_turned(const Segment& segment, const AxesAlong& axes, double shift, std::size_t first_piece,
                     bool first, std::vector<ForcePiece>& pieces);

  const ForceSource& source_;
  const Program& program_;
  const Toolpath& path_;
  const std::vector<Matrix3>& R_MT_;
  Coverage coverage_;
  StretchForce stretch_;            // of the current stretch
  std::vector<ForcePiece> turned_;  // of one of its pieces
};

}  // namespace counterflex
