#pragma once
/// Constants of this module that were tuned, and what other values do: 118 runs over the samples and over
/// programs of shops for mills and the Orthoglide, 36803 lines of text. "No text" are texts that differ.
/// Shares are of the tolerance.
#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// A difference that is not followed: a step of the correction, a bend between samples, what a shift leaves
/// to a turn. 0.05: no text; 0.2: 4 texts, 9 lines less.
inline constexpr double small_share = 0.1;

/// A piece that comes nearer to the tolerance is sampled closer: twice the difference that is not followed.
inline constexpr double near_share = 1 - 2 * small_share;

/// Accuracy of the sampled correction, of gains, and of what rounding must leave where points are inserted.
/// 0.005 and 0.02: 3 and 2 texts in their last digits. An arc that is fitted to the correction leaves it,
/// too: 0.005 and 0.03: 11 lines less and 81 more of 297093 in 151 runs.
inline constexpr double curve_share = 0.01;

/// Of the room for knots: a line whose bound is below is not sampled. Another force on each of 12000 blocks:
/// 1.04 s with 0, 0.61 s with 0.25, 0.62 s with 0.5, the same text.
inline constexpr double bend_share = 0.25;

/// What the heights of a contour or of a corner may miss; flat parts beside corners may miss the rest. 0.6:
/// no text.
inline constexpr double height_share = 0.3;

/// A centre that the curve hardly determines keeps its place: weight beside the mean square of the misses. 0,
/// half and twice as much: 25 to 29 texts, 58 and 33 lines less, 46 lines more.
inline constexpr double pull_to_source = 4e-4;

/// An arc of half a turn is halved so often, and twice as often where that saves chords. 0: 22
/// texts, 11343 lines more; without a limit where that saves chords: 1 text, 10 lines more.
inline constexpr int first_halvings = 3;

/// Places in which a feed move is judged are so far apart, at most. Of 95 of the runs, 2.5
/// and 10 mm: no text.
inline constexpr double between_places = 5 * mm;

/// The same around an arc, and of a turn of the tool. Samples that fit an arc are as far apart. Of 95 of the
/// runs, twice and half as far: no text; for samples that fit, half as far: 5 texts of 151 runs, as many
/// lines.
inline constexpr double angle_between_places = pi / 8;

/// Between places around an arc the force leaves its chord by this part of itself, at most. The largest
/// deviation is as near to that of a place. A force in the feed frame has places 2.6 degrees apart: 0.02 %.
inline constexpr double turn_of_force = 2.5e-4;

}  // namespace counterflex
