#pragma once
/// Slices of work for several threads.
#include <algorithm>
#include <cstddef>

#include "counterflex/files/parallel.hpp"

namespace counterflex {

/// Segments or places that one thread works on: full batches, and several slices in a window. Of no effect on
/// results.
inline constexpr std::size_t slice_size = 256;

inline std::size_t slice_count(std::size_t items) {
  return (items + slice_size - 1) / slice_size;
}

/// Calls `work(begin, count)` for every slice of `items`, of at most `size`, on several threads.
template <class Work>
void for_each_slice(std::size_t items, int threads, const Work& work, std::size_t size = slice_size) {
  for_each_index((items + size - 1) / size, threads, [&](std::size_t slice) {
    const std::size_t begin = slice * size;
    work(begin, std::min(items - begin, size));
  });
}

}  // namespace counterflex
