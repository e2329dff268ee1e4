#pragma once
/// Divides an arc into pieces that a control can read.
#include "compensation/plan/arc_fit.hpp"

namespace counterflex {

/// Pieces of an arc, one after the other.
struct ArcPieces {
  std::vector<Via> vias;     ///< chords have no centre
  std::vector<double> ends;  ///< fractions of the arc at which they end
  TextPosition held;         ///< where the text holds the tool behind them
  bool lack_digits = false;  ///< a chord is needed, and rounding leaves no room for it
};

/// What an arc is divided into between fractions `u0` and `u1` without a step of the correction: one arc if
/// that is good enough, else several, divided at corners first, then in halves, and what is half a turn at
/// most into eight, and more where that saves chords; chords of the commanded curve only where none of them
/// fits. `from`: where the text holds the tool.
ArcPieces divide_arc(const ArcTask& task, double u0, double u1, const TextPosition& from);

}  // namespace counterflex
