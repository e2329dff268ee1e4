#pragma once
/// Work on several threads. What it computes does not depend on their number.
#include <cstddef>
#include <functional>

#include "compensation/tuning.hpp"

namespace counterflex {

inline std::size_t slice_count(std::size_t items) {
  return (items + slice_size - 1) / slice_size;
}

/// Calls `work` once for every index below `count`, on `threads` threads. Throws what `work` throws, after
/// all threads have ended.
void for_each_index(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace counterflex
