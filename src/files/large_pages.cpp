#include "counterflex/files/large_pages.hpp"

#include <sys/mman.h>

#include <memory>

namespace counterflex {

void prefer_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr std::size_t large = 1 << 21;
  std::size_t rest = bytes;
  if (std::align(large, large, memory, rest) != nullptr) madvise(memory, rest / large * large, MADV_HUGEPAGE);
#endif
}

}  // namespace counterflex
