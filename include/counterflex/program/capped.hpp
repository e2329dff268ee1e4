#pragma once
/// Lists of things that stand in lines, of which a report shows the first ones.
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace counterflex {

/// What is listed of blocks left alone and of warnings.
inline constexpr std::size_t listed_at_most = 100;

/// A list that is capped; `count` is what it would hold otherwise.
template <typename T>
struct Capped {
  std::vector<T> rows;
  std::size_t count = 0;
};

/// Adds `row` where its `line` puts it: what has none (0) comes first, rows of one line stay in the order in
/// which they came. Of more than `listed_at_most` rows the last goes.
template <typename T>
void list(Capped<T>& capped, T row) {
  ++capped.count;
  auto& rows = capped.rows;
  if (rows.size() == listed_at_most && rows.back().line <= row.line) return;
  const auto place =
      std::upper_bound(rows.begin(), rows.end(), row, [](const T& a, const T& b) { return a.line < b.line; });
  rows.insert(place, std::move(row));
  if (rows.size() > listed_at_most) rows.pop_back();
}

/// As if all that `later` has counted had come after what `capped` has.
template <typename T>
void list(Capped<T>& capped, const Capped<T>& later) {
  const std::size_t count = capped.count + later.count;
  for (const T& row : later.rows) list(capped, row);
  capped.count = count;
}

}  // namespace counterflex
