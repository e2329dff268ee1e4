#include "counterflex/files/large_pages.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

using namespace counterflex;

TEST_CASE("memory asked for in large pages holds what is put there, whatever its size and place") {
  prefer_large_pages(nullptr, 0);
  for (const std::size_t size :
       {std::size_t{1}, std::size_t{4096}, std::size_t{3} << 20, std::size_t{9} << 20}) {
    std::vector<char> memory(size, 'a');
    const std::size_t skipped = std::min<std::size_t>(size - 1, 5);
    prefer_large_pages(memory.data() + skipped, size - skipped);
    memory.back() = 'z';
    CHECK(std::count(memory.begin(), memory.end(), 'a') == static_cast<std::ptrdiff_t>(size - 1));
  }
}
