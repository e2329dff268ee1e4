#pragma once
/// A wrench in axes that turn along a segment.
#include <span>
#include <vector>

#include "forces/path/raw_forces.hpp"

namespace counterflex {

/// The axes of a profile's frame along one segment: those of the feed turn on an arc, and the tool's where
/// its orientation changes. `R_MT` are its orientations at equal fractions, from start to end, or one for
/// all.
class AxesAlong {
 public:
  AxesAlong(ForceFrame frame, const Segment& segment, const Matrix3& R_MW, std::span<const Matrix3> R_MT)
      : frame_(frame), segment_(segment), R_MW_(R_MW), R_MT_(R_MT) {}

  bool turn() const;
  bool are_of_machine() const { return frame_ == ForceFrame::machine; }

  /// Number of equal pieces that are short enough for the error in the middle to show how the axes turn.
  int pieces() const;

  /// The axes at a fraction of the segment. Where the feed of an arc is parallel to the tool at a single
  /// place, the axes of a place slightly further `towards` are used.
  ForceAxes at(double fraction, double towards) const;

 private:
  Matrix3 tool_at(double fraction) const;

  ForceFrame frame_;
  const Segment& segment_;
  const Matrix3& R_MW_;
  std::span<const Matrix3> R_MT_;
};

/// Converts `piece` of `segment` from the frame of `axes` to machine axes: to one piece or, if the axes turn,
/// to as many as keep each linear within 1e-4 of the wrench. The wrench steps where the axes flip: at the
/// place of an arc where the feed is parallel to the tool. Marks pieces that continue smoothly, never the
/// first one. Replaces the contents of `pieces`.
void turn_pieces(const ForcePiece& piece, const Segment& segment, const AxesAlong& axes,
                 std::vector<ForcePiece>& pieces);

/// Whether two adjacent wrenches differ by at most the error of an arc's tangent from rounded coordinates.
bool nearly_same(const Vector6& A, const Vector6& B);

}  // namespace counterflex
