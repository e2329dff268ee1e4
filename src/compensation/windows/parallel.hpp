#pragma once
/// Slices of work for several threads.
#include <cstddef>

#include "compensation/tuning.hpp"
#include "counterflex/files/parallel.hpp"

namespace counterflex {

inline std::size_t slice_count(std::size_t items) {
  return (items + slice_size - 1) / slice_size;
}

}  // namespace counterflex
