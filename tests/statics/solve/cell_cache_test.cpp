/// What is kept of cells, and what is forgotten.
#include "statics/solve/cell_cache.hpp"

#include <doctest/doctest.h>

using namespace counterflex;
using kernel::StartCell;

namespace {

const int some_table = 0, other_table = 0;

CellCache::Key key(long x, const void* table = &some_table, int kind = 0) {
  return {table, kind, {{x, 0, 0}, {}}};
}

std::shared_ptr<const StartCell> make_cell(std::size_t numbers = 1000) {
  StartCell cell;
  cell.state.resize(numbers);
  return std::make_shared<const StartCell>(std::move(cell));
}

std::shared_ptr<const StartCell> not_called() {
  FAIL("what is kept is made again");
  return nullptr;
}

}  // namespace

TEST_CASE("a thing that is kept is not made again, also where nothing can be made") {
  CellCache cache(100'000);
  const auto made = cache.get<StartCell>(key(1), [] { return make_cell(); });
  CHECK(cache.get<StartCell>(key(1), not_called) == made);
  const auto none = [] { return std::shared_ptr<const StartCell>(); };
  CHECK(cache.get<StartCell>(key(2), none) == nullptr);
  CHECK(cache.get<StartCell>(key(2), not_called) == nullptr);
}

TEST_CASE("cells of different kinds and tables are different") {
  CellCache cache(100'000);
  const auto get = [&](const CellCache::Key& k) {
    return cache.get<StartCell>(k, [] { return make_cell(); });
  };
  const auto first = get(key(1));
  CHECK(get(key(1, &some_table, 1)) != first);
  CHECK(get(key(1, &other_table)) != first);
  CHECK(get(key(1)) == first);
}

TEST_CASE("all kinds and tables together keep to one number of bytes, and the newest stay") {
  constexpr std::size_t most = 200'000;
  CellCache cache(most);
  std::vector<std::weak_ptr<const StartCell>> given;
  for (long i = 0; i < 100; ++i) {
    const CellCache::Key k = key(i, i % 2 == 0 ? &some_table : &other_table, static_cast<int>(i % 3));
    given.emplace_back(
        cache.get<StartCell>(k, [&] { return make_cell(100 * static_cast<std::size_t>(1 + i % 9)); }));
    CHECK(given.back().lock());
    CHECK(cache.get<StartCell>(k, not_called));
    std::size_t bytes = 0;
    for (const auto& cell : given)
      if (const auto kept = cell.lock()) bytes += bytes_of(*kept);
    CAPTURE(i);
    CHECK(bytes <= most);
    CHECK((i < 50 || bytes >= most / 2));
  }
}

TEST_CASE("what is larger than the whole memory is made for each use") {
  CellCache cache(1'000);
  for (int i = 0; i < 3; ++i) CHECK(cache.get<StartCell>(key(i), [] { return make_cell(); }));
}
