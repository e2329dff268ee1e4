#pragma once
/// Memory for what grows with a program.
#include <cstddef>

namespace counterflex {

/// Asks the system to hold `memory`, of which nothing is used yet, in large pages: of many megabytes half the
/// time to fill them goes into getting small ones. Nothing happens where the system has no large pages, or
/// where they are larger than the memory. Does not throw.
void prefer_large_pages(void* memory, std::size_t bytes);

}  // namespace counterflex
