#pragma once
/// What is kept of the cells in which the kernel starts.
#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <utility>
#include <vector>

#include "counterflex/statics/mechanism.hpp"
#include "statics/kernel/cells/start_cell.hpp"

namespace counterflex {

/// A cell by its place on the lattices of positions and, where the machine controls an orientation, of
/// rotation vectors against home.
struct CellIndex {
  std::array<long, 3> position{}, turn{};
  bool operator==(const CellIndex&) const = default;
};

std::size_t bytes_of(const kernel::StartCell& cell);
std::size_t bytes_of(const Configuration& configuration);

/// The things made last by all tables of a run, up to a number of bytes; null where nothing can be made. What
/// is made depends on its key alone: if two threads make the same thing at once, either may be kept.
class CellCache {
 public:
  /// Things of one kind in one table, and the cell.
  struct Key {
    const void* table;
    int kind;
    CellIndex index;
    bool operator==(const Key&) const = default;
  };

  explicit CellCache(std::size_t most_bytes) : most_(most_bytes) {}

  /// Calls `make` for what is not there. `bytes_of` knows the size of a `Thing`.
  template <class Thing, class Make>
  std::shared_ptr<const Thing> get(const Key& key, const Make& make) {
    {
      const std::lock_guard lock(mutex_);
      if (const auto found = things_.find(key); found != things_.end()) return use<Thing>(found->second);
    }
    std::shared_ptr<const Thing> made = make();
    const std::size_t bytes = sizeof(Entry) + (made ? bytes_of(*made) : 0);
    const std::lock_guard lock(mutex_);
    if (bytes_ + bytes > most_) forget_oldest_quarter();
    const auto [item, is_new] = things_.try_emplace(key, Entry{std::move(made), bytes, 0});
    if (is_new) bytes_ += bytes;
    return use<Thing>(item->second);
  }

 private:
  struct Entry {
    std::shared_ptr<const void> thing;
    std::size_t bytes;
    unsigned long used;
  };
  struct Hash {
    std::size_t operator()(const Key& key) const {
      constexpr std::array<std::size_t, 3> primes{73856093, 19349663, 83492791};
      std::size_t hash = std::hash<const void*>()(key.table) + static_cast<std::size_t>(key.kind);
      for (std::size_t k = 0; k < 3; ++k)
        hash ^= static_cast<std::size_t>(key.index.position[k] + 7919L * key.index.turn[k]) * primes[k];
      return hash;
    }
  };

  template <class Thing>
  std::shared_ptr<const Thing> use(Entry& entry) {
    entry.used = ++clock_;
    return std::static_pointer_cast<const Thing>(entry.thing);
  }

  void forget_oldest_quarter() {
    std::vector<std::pair<unsigned long, std::size_t>> ages;  // when used, and bytes
    for (const auto& [key, entry] : things_) ages.emplace_back(entry.used, entry.bytes);
    std::ranges::sort(ages, std::greater());
    bytes_ = 0;
    unsigned long oldest = 0;  // that is kept
    for (const auto& [used, bytes] : ages) {
      if (bytes_ + bytes > most_ / 4 * 3) break;
      bytes_ += bytes;
      oldest = used;
    }
    std::erase_if(things_, [&](const auto& item) { return oldest == 0 || item.second.used < oldest; });
  }

  const std::size_t most_;
  std::mutex mutex_;
  std::unordered_map<Key, Entry, Hash> things_;
  std::size_t bytes_ = 0;
  unsigned long clock_ = 0;
};

}  // namespace counterflex
