#pragma once
/// The constants of this module that were tuned, and what other values do: 46 runs over 23 programs of shops
/// and the samples, 9280 lines of text. "No text" are texts that differ. Shares are of the tolerance.
#include <cstddef>

namespace counterflex {

/// Segments or places that one thread works on: full batches, and several slices in a window.
inline constexpr std::size_t slice_size = 256;

/// A difference that is not followed: a step of the correction, a bend between samples, what a shift leaves
/// to a turn. Three times as much, and five times for the turn: no text, no verdict.
inline constexpr double small_share = 0.1;

/// A piece that comes nearer to the tolerance is sampled closer. 1: no text, no verdict, and no margin.
inline constexpr double near_share = 0.8;

/// Accuracy of the sampled correction. 0.03: 6 texts in their last digits.
inline constexpr double curve_share = 0.01;

/// Of the room for knots: a line whose bound is below is not sampled. Another force on each of 12000 blocks:
/// 1.04 s with 0, 0.61 s with 0.25, 0.62 s with 0.5, the same text.
inline constexpr double bend_share = 0.25;

/// What rounding must leave where points are inserted. 0: no text, no verdict.
inline constexpr double least_share = 0.02;

/// What the heights of a contour may miss; flat parts beside corners may miss the rest. 0.6: no text.
inline constexpr double height_share = 0.3;

/// A centre of an arc that misses by less is kept. 1: 8 texts; 0.1: 14 texts, one line less.
inline constexpr double centre_kept_share = 0.5;

/// A centre that the curve hardly determines keeps its place: weight beside the mean square of the misses. 0:
/// 11 texts, 17 lines less; ten times as much: 10 texts, 60 lines more.
inline constexpr double pull_to_source = 4e-4;

/// An arc of half a turn is halved so often, and twice as often where that saves chords. 2 and 4: no text.
inline constexpr int first_halvings = 3;

/// Roundings to the last digit that a relation between positions may be off by: of a start, an end and a
/// centre, and of the original's. 2: no text, no verdict.
inline constexpr double roundings = 4;

}  // namespace counterflex
