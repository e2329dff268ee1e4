#pragma once
/// How far something is, in words.
#include <cstddef>
#include <string>

namespace counterflex::cli {

struct Progress {
  double share = 0;           ///< of the work, 0 to 1
  std::size_t waypoints = 0;  ///< solved so far
  double elapsed = 0;         ///< s
};

/// ", 34000 waypoints/s, 2 min left"; empty in the first two seconds.
std::string rate_text(const Progress& progress);

/// "[######--------------]  31 %, 34000 waypoints/s, 2 min left".
std::string progress_bar(const Progress& progress);

/// "40 s", "3 min", "2 h 10 min".
std::string duration_text(double seconds);

}  // namespace counterflex::cli
