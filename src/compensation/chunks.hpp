#pragma once
/// Work in chunks of fixed size: what a chunk computes depends on the chunk alone, never on the number of
/// threads.
#include <cstddef>
#include <functional>

namespace counterflex {

/// Enough for full batches of waypoints, few enough that a window keeps several threads busy.
inline constexpr std::size_t chunk_size = 256;

struct Chunk {
  std::size_t index, begin, end;  ///< items [begin, end)
};

inline std::size_t chunk_count(std::size_t items) {
  return (items + chunk_size - 1) / chunk_size;
}

/// Calls `work` once for every index below `count`, on `threads` threads. Exceptions are passed on after all
/// threads ended.
void for_each_index(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

/// The same for every chunk of `items`.
void for_each_chunk(std::size_t items, int threads, const std::function<void(const Chunk&)>& work);

}  // namespace counterflex
