#pragma once
/// The wrench as source and profile give it, before the mean is taken.
#include <optional>
#include <span>
#include <vector>

#include "counterflex/forces/forces.hpp"
#include "forces/alignment.hpp"

namespace counterflex {

/// The axes in which a force is given, in the machine frame.
struct ForceAxes {
  Matrix3 R_MF = Matrix3::Identity();
  bool only_z = false;  ///< feed parallel to the tool: no lateral direction
};

/// Axes x, y, z of the feed frame: z the tool's, y = unit(z x feed), x = y x z.
ForceAxes feed_axes(const Vector3& feed_M, const Matrix3& R_MT);

/// The axes of `frame` where the tool moves along `feed_M`.
ForceAxes axes_of(ForceFrame frame, const Vector3& feed_M, const Matrix3& R_MW, const Matrix3& R_MT);

/// F in machine axes.
Vector6 in_machine_axes(const ForceAxes& axes, const Vector6& F);

/// The profile over the keys of one segment, in the profile's frame: pieces on which it is linear. `s0`, `s1`
/// are path lengths of the segment.
std::vector<ForcePiece> profile_pieces(const ForceProfile& profile, const KeySpan& keys,
                                       const Segment& segment);

/// Appends `piece` to the pieces of a run that begin at `first`; one that goes on with the same constant is
/// made longer.
void append(const ForcePiece& piece, std::size_t first, std::vector<ForcePiece>& pieces);

/// The wrench of one segment after the other in machine axes.
class Unblended {
 public:
  /// Borrows all. `R_MT` as for `PathForces`; `block_number` is N of the moves before, and then of these.
  Unblended(const ForceSource& source, const Program& program, const Toolpath& path,
            const std::vector<Matrix3>& R_MT, std::optional<long>& block_number);

  /// Appends the pieces of segment i to those of its run, which begin at `first_piece`; a plunge that loses
  /// lateral forces is noted.
  void append_to(std::size_t i, std::size_t first_piece, std::vector<ForcePiece>& pieces,
                 std::vector<ForceNote>& notes) const;

 private:
  const ForceProfile* profile() const;
  std::span<const Matrix3> orientations(std::size_t i) const;  ///< of the tool on segment i
  bool in_air(const Segment& segment) const;
  bool goes_on_round(const ForcePiece& piece, std::size_t first_piece,
                     const std::vector<ForcePiece>& pieces) const;
  Vector6 uniform(const Segment& segment) const;

  const ForceSource& source_;
  const Program& program_;
  const Toolpath& path_;
  const std::vector<Matrix3>& R_MT_;
  std::vector<KeySpan> keys_;
};

}  // namespace counterflex
