#pragma once
/// The parts of the path that a profile covers.
#include <vector>

#include "counterflex/forces/forces.hpp"
#include "forces/path/profile/alignment.hpp"

namespace counterflex {

/// Keys from `start` to `end` that rows of a profile cover. Keys are rounded: without another force the cover
/// extends from `least` to `most`.
struct KeyCover {
  double start = 0, end = 0;
  double least = 0, most = 0;
  std::size_t row = 0;  ///< the first row that acts
};

/// Appends the covers that touch `keys`, in order. `alone`: there is no other rule, so that the path before
/// the first row and after the last one is rounding, or an error that `ForceCover` reports.
void append_covers(const ForceProfile& profile, const KeySpan& keys, bool alone,
                   std::vector<KeyCover>& found);

/// The row that acts at `key`: the last one that is not after it, else the first.
std::size_t row_at(const ForceProfile& profile, double key);

/// Tolerance of keys: lengths and times in files are rounded, and sums of rounded values drift. 1 µm or 1 ms,
/// plus a millionth of the whole.
double key_margin(const ForceProfile& profile, double key);

/// How far a profile extends before its first and after its last row. Logged positions represent the path
/// near them.
double reach(const ForceProfile& profile, double key);

}  // namespace counterflex
