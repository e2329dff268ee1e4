#pragma once
/// Ways that are gone in parts.
#include <algorithm>

namespace counterflex {

/// Goes a way from 0 to 1: `advance(from, to)` returns whether it arrived at `to`. The first part is `first`.
/// A part that fails is halved; false where one of `smallest` fails.
template <class Advance>
bool by_parts(double first, double smallest, const Advance& advance) {
  double done = 0, part = first;
  while (done < 1) {
    const double next = std::min(1.0, done + part);
    if (advance(done, next))
      done = next;
    else if ((part /= 2) < smallest)
      return false;
  }
  return true;
}

}  // namespace counterflex
