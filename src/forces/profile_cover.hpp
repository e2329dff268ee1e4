#pragma once
/// What a profile covers of the path.
#include <vector>

#include "counterflex/forces/forces.hpp"
#include "forces/alignment.hpp"

namespace counterflex {

/// Keys from `start` to `end` that rows of a profile cover. Keys are rounded: the cover reaches over them,
/// from `least` to `most`, where nothing else acts.
struct KeyCover {
  double start = 0, end = 0;
  double least = 0, most = 0;
  std::size_t row = 0;  ///< the first one that acts
};

/// Appends the covers that touch `keys`, in order. `alone`: no other rule is given, so that what lies before
/// the first row and behind the last one is rounding, or an error that `ForceCover` tells.
void append_covers(const ForceProfile& profile, const KeySpan& keys, bool alone,
                   std::vector<KeyCover>& found);

/// The row that holds at `key`: the last one that is not beyond it, else the first.
std::size_t row_at(const ForceProfile& profile, double key);

/// Lengths and times in files are rounded, and sums of rounded ones drift: 1 um or 1 ms, and a millionth of
/// the whole.
double key_margin(const ForceProfile& profile, double key);

/// How far before its first row and behind its last one a profile reaches. Logged positions stand for the
/// path near them.
double reach(const ForceProfile& profile, double key);

}  // namespace counterflex
