#pragma once
/// A wrench in axes that turn along a segment.
#include <span>
#include <vector>

#include "forces/unblended.hpp"

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

  /// Pieces of equal length that are short enough for the middle of each to tell how the axes turn in it.
  int pieces() const;

  /// At a fraction of the segment's way. Where the feed of an arc is for a moment parallel to the tool, the
  /// axes of a place a little further `towards` are meant.
  ForceAxes at(double fraction, double towards) const;

 private:
  Matrix3 tool_at(double fraction) const;

  ForceFrame frame_;
  const Segment& segment_;
  const Matrix3& R_MW_;
  std::span<const Matrix3> R_MT_;
};

/// `piece` of `segment`, given in the frame of `axes`, in machine axes: one piece, or where the axes turn as
/// many as keep each linear to within 1e-4 of the wrench. Where they flip, at the place of an arc at which
/// the feed is parallel to the tool, the wrench steps. Pieces that go on smoothly are marked so, the first
/// one never. They come into `pieces`, which loses what it held.
void turn_pieces(const ForcePiece& piece, const Segment& segment, const AxesAlong& axes,
                 std::vector<ForcePiece>& pieces);

/// Whether two wrenches that meet differ by no more than what rounded coordinates turn an arc's tangent.
bool nearly_same(const Vector6& A, const Vector6& B);

}  // namespace counterflex
