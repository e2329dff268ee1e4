#pragma once
/// Work on several threads. What it computes does not depend on their number.
#include <cstddef>
#include <functional>

namespace counterflex {

/// Calls `work` once for every index below `count`, on `threads` threads. Throws what `work` throws, after
/// all threads have ended.
void for_each_index(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace counterflex
