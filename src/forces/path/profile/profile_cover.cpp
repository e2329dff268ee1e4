#include "forces/path/profile/profile_cover.hpp"

#include <algorithm>
#include <limits>

namespace counterflex {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The first row from `row` on that ends the cover, or is after `key`.
std::size_t end_of_cover(const ForceProfile& profile, std::size_t row, double key) {
  const auto& rows = profile.rows;
  while (row < rows.size() && !rows.ends(row) && rows.key(row) <= key) ++row;
  return row;
}

/// The cover by the rows [row, end).
KeyCover cover_by(const ForceProfile& profile, std::size_t row, std::size_t end, bool alone) {
  const auto& rows = profile.rows;
  KeyCover cover{rows.key(row), unlimited, rows.key(row), unlimited, row};
  if (row == 0) cover.least = alone ? -unlimited : cover.start - reach(profile, cover.start);
  if (end < rows.size()) {
    cover.end = cover.most = rows.key(end);
  } else if (profile.linear) {
    cover.end = rows.key(rows.size() - 1);
    cover.most = alone ? unlimited : cover.end + reach(profile, cover.end);
  }
  return cover;
}

}  // namespace

void append_covers(const ForceProfile& profile, const KeySpan& keys, bool alone,
                   std::vector<KeyCover>& found) {
  const auto& rows = profile.rows;
  const auto add = [&](std::size_t row, std::size_t end) {
    const KeyCover cover = cover_by(profile, row, end, alone);
    if (cover.least <= keys.end && cover.most >= keys.start) found.push_back(cover);
  };
  std::size_t row = row_at(profile, keys.start);
  // The row of a line or a block number is the last one that is not beyond it.
  if (keys.start == keys.end && row < rows.size() && !rows.ends(row) && rows.key(row) <= keys.end)
    return add(row, row + 1);
  while (row < rows.size()) {
    if (rows.ends(row)) {
      ++row;
      continue;
    }
    if (row > 0 && rows.key(row) > keys.end) break;
    const std::size_t end = end_of_cover(profile, row, keys.end);
    add(row, std::max(end, row + 1));
    row = std::max(end, row + 1);
    if (row < rows.size() && rows.key(row) > keys.end) break;
  }
}

std::size_t row_at(const ForceProfile& profile, double key) {
  const std::size_t beyond = profile.rows.beyond(key);
  return beyond == 0 ? 0 : beyond - 1;
}

double key_margin(const ForceProfile& profile, double key) {
  if (profile.key == ForceKey::path_length) return 1e-6 + 1e-6 * key;
  return profile.key == ForceKey::time ? 1e-3 + 1e-6 * key : 0;
}

double reach(const ForceProfile& profile, double key) {
  return std::max(profile.within.value_or(0), key_margin(profile, key));
}

}  // namespace counterflex
