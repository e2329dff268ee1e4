#pragma once
/// Lists with line numbers that are limited in length: a report shows the first rows.
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace counterflex {

/// Largest number of rows in the lists of uncorrected blocks and of warnings.
inline constexpr std::size_t listed_at_most = 100;

/// A list of limited length. `count` is the number of rows without the limit.
template <typename T>
struct Capped {
  std::vector<T> rows;
  std::size_t count = 0;
};

/// Inserts `row` in the order of lines. Rows without a line (0) come first, rows of one line keep their
/// order. If there are more than `listed_at_most` rows, the last one is dropped.
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

/// Appends the rows of `later` and adds its count.
template <typename T>
void list(Capped<T>& capped, const Capped<T>& later) {
  const std::size_t count = capped.count + later.count;
  for (const T& row : later.rows) list(capped, row);
  capped.count = count;
}

}  // namespace counterflex
