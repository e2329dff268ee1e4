#include "forces/alignment.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "forces/csv_header.hpp"

namespace counterflex {
namespace {

[[noreturn]] void fail_row(const ForceProfile& profile, std::size_t row, const std::string& message) {
  throw InputError(Exit::machine_or_force, profile.rows[row].where,
                   fmt::format("row {}: {}", row + 1, message));
}

std::string shown(const ForceProfile& profile, double key) {
  return fmt::format("{} {:.9g}", csv::key_name(profile.key), key * csv::shown_per_si(profile.key));
}

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

/// Lengths and times in files are rounded, and sums of rounded ones drift: 1 um or 1 ms, and a millionth of
/// the whole.
double tolerance(const ForceProfile& profile, double end) {
  if (profile.key == ForceKey::path_length) return 1e-6 + 1e-6 * end;
  return profile.key == ForceKey::time ? 1e-3 + 1e-6 * end : 0;
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

void ForceCover::add(const Program& window, const Toolpath& path) {
  const std::vector<KeySpan> keys = align(profile_, window, path, block_number_);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Segment& segment = path.segments[i];
    if (!segment.cutting) continue;
    // Lines and block numbers need not grow along the path.
    if (!first_ || keys[i].start < first_->key) first_ = {keys[i].start, segment.line};
    if (!last_ || keys[i].end >= last_->key) last_ = {keys[i].end, segment.line};
  }
  for (const Move& move : window.moves)
    last_block_number_ = std::max(last_block_number_, move.block_number.value_or(0));
  if (!window.moves.empty()) last_line_ = window.moves.back().line;
  newlines_ += std::count(window.text.begin(), window.text.end(), '\n');
  if (!window.text.empty()) ends_in_line_ = window.text.back() != '\n';
  file_lines_ = window.expansion.file_lines;
  end_ = path.end;
}

/// The greatest key that the program has.
double ForceCover::end() const {
  switch (profile_.key) {
    case ForceKey::line:
      if (file_lines_ > 0) return static_cast<double>(file_lines_);
      return static_cast<double>(std::max(newlines_ + (ends_in_line_ ? 1 : 0), last_line_));
    case ForceKey::block_number:
      return static_cast<double>(last_block_number_);
    case ForceKey::path_length:
      return end_.s;
    default:
      return end_.t;
  }
}

void ForceCover::check() const {
  const double last_key = end(), margin = tolerance(profile_, last_key);
  const std::vector<ForceRow>& rows = profile_.rows;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].key > last_key + margin)
      fail_row(profile_, i,
               fmt::format("{} lies beyond the program, which ends at {}", shown(profile_, rows[i].key),
                           shown(profile_, last_key)));
  if (!first_) return;
  if (rows.front().key > first_->key + margin)
    fail_row(profile_, 0,
             fmt::format("{} is the first row, but the program cuts from {} on (line {}): a row there is "
                         "required, with zeros where nothing is cut",
                         shown(profile_, rows.front().key), shown(profile_, first_->key), first_->line));
  if (profile_.linear && rows.back().key < last_->key - margin)
    fail_row(profile_, rows.size() - 1,
             fmt::format("{} is the last row, but the program cuts until {} (line {}): a row there is "
                         "required for linear interpolation",
                         shown(profile_, rows.back().key), shown(profile_, last_->key), last_->line));
}

}  // namespace counterflex
