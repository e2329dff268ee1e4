#pragma once
/// Slices of work for several threads.
#include <cstddef>

#include "counterflex/files/parallel.hpp"

namespace counterflex {

/// Segments or places that one thread works on: full batches, and several slices in a window. Of no effect on
/// results.
inline constexpr std::size_t slice_size = 256;

inline std::size_t slice_count(std::size_t items) {
  return (items + slice_size - 1) / slice_size;
}

}  // namespace counterflex
