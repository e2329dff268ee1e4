#pragma once
/// Work on several threads. What it computes does not depend on their number.
#include <cstddef>
#include <functional>

namespace counterflex {

/// Segments or pieces that one thread works on: enough for full batches of waypoints, few enough that a
/// window keeps several threads busy.
inline constexpr std::size_t slice_size = 256;

inline std::size_t slice_count(std::size_t items) {
  return (items + slice_size - 1) / slice_size;
}

/// Calls `work` once for every index below `count`, on `threads` threads. Throws what `work` throws, after
/// all threads have ended.
void for_each_index(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace counterflex
