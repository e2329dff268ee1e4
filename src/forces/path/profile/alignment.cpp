#include "forces/path/profile/alignment.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "forces/read/csv_header.hpp"

namespace counterflex {

Location place_of_row(const ForceProfile& profile, std::size_t row) {
  const RowPlace where = profile.rows[row].where;
  return {profile.file, where.line, where.column};
}

void fail_row(const ForceProfile& profile, std::size_t row, const std::string& message) {
  // A profile made from a log has fewer rows than the file of the log.
  const bool counted = !profile.within || profile.key == ForceKey::point;
  throw InputError(ErrorKind::machine_or_force, place_of_row(profile, row),
                   counted ? fmt::format("row {}: {}", row + 1, message) : message);
}

namespace {

/// A move without N belongs to the block number before it.
std::vector<KeySpan> block_numbers(const ForceProfile& profile, const Program& program, const Toolpath& path,
                                   std::optional<long>& n) {
  std::vector<KeySpan> keys(path.segments.size());
  std::size_t segment = 0;
  for (std::size_t i = 0; i < program.moves.size(); ++i) {
    const Move& move = program.moves[i];
    if (n && move.block_number && *move.block_number < *n) {
      fail_row(profile, 0,
               fmt::format("key n needs block numbers that never decrease, line {} has N{} after N{}",
                           move.line, *move.block_number, *n));
    }
    if (move.block_number) n = move.block_number;
    if (segment == path.segments.size() || path.segments[segment].move != i) continue;
    if (!n && path.segments[segment].cutting) {
      fail_row(
          profile, 0,
          fmt::format("key n needs block numbers, the move in line {} has none at or before it", move.line));
    }
    const double key = static_cast<double>(n.value_or(0));
    keys[segment++] = {key, key};
  }
  return keys;
}

KeySpan times(const ForceProfile& profile, const Segment& segment) {
  if (segment.cutting && segment.feed_m_s <= 0)
    fail_row(profile, 0, fmt::format("key t_s needs a feed, the move in line {} has none", segment.line));
  return {segment.t_start, segment.t_end};
}

}  // namespace

std::vector<KeySpan> align(const ForceProfile& profile, const Program& program, const Toolpath& path,
                           std::optional<long>& block_number) {
  if (profile.key == ForceKey::block_number) return block_numbers(profile, program, path, block_number);
  std::vector<KeySpan> keys;
  keys.reserve(path.segments.size());
  for (const Segment& segment : path.segments) {
    const double line = segment.line;
    if (profile.key == ForceKey::line) keys.push_back({line, line});
    if (profile.key == ForceKey::path_length) keys.push_back({segment.s_start, segment.s_end});
    if (profile.key == ForceKey::time) keys.push_back(times(profile, segment));
  }
  return keys;
}

}  // namespace counterflex
