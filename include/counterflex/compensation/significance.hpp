#pragma once
/// Corrections that are below their own uncertainty.
#include <cstddef>
#include <vector>

#include "counterflex/compensation/windows.hpp"

namespace counterflex {

/// The share of its band that a deviation has at most where a target stays as programmed; the rest is for
/// numbers that are computed in another way by the verification.
inline constexpr double certain_share = 0.999;

/// The same along a move in which the correction fades out, beside what rounding takes of the tolerance:
/// there the verification has other samples, and the tip does not move exactly as the command does.
inline constexpr double fading_share = 0.98;

/// By number of the program's move, whether its end stays as programmed: the deviation before correction is
/// below its band (`is_below_band`) at all samples of this move and of the next one that goes somewhere.
///
/// Along a move of which one end stays and the other does not, the share of the correction changes evenly
/// from 0 to 1. This is for rapids, and for lines that may be split and take words of all axes, have no
/// corners, and are below `fading_share` of their bands, less the share of rounding in the tolerance. Of
/// other moves both ends stay, or none.
///
/// These ends keep their correction: of moves that are held, in a contour group, not followed or behind such
/// a move, and of the moves before them. Empty where the program is not solved without a correction: all ends
/// keep theirs.
///
/// `windows`: of a program, with uncertainties. Reads them to their end. Does not depend on their size, nor
/// on `threads`. Throws as `predict_windows`. `events`: for progress, as those of a prediction.
std::vector<bool> targets_as_programmed(JobWindows& windows, int threads, const WindowEvents& events);

}  // namespace counterflex
