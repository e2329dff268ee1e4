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
std::vector<KeySpan> block_numbers(const ForceProfile& profile, const Program& program,
                                   const Toolpath& path) {
  std::vector<KeySpan> keys(path.segments.size());
  std::optional<long> n;
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

double last_line(const Program& program) {
  if (program.expansion.file_lines > 0) return program.expansion.file_lines;
  const std::string& text = program.text;
  auto lines = std::count(text.begin(), text.end(), '\n');
  if (!text.empty() && text.back() != '\n') ++lines;
  const long of_moves = program.moves.empty() ? 0 : program.moves.back().line;
  return static_cast<double>(std::max<long>(lines, of_moves));
}

double last_block_number(const Program& program) {
  long n = 0;
  for (const Move& move : program.moves) n = std::max(n, move.block_number.value_or(0));
  return static_cast<double>(n);
}

/// The greatest key that the program has.
double end_of_program(const ForceProfile& profile, const Program& program, const Toolpath& path) {
  if (profile.key == ForceKey::line) return last_line(program);
  if (profile.key == ForceKey::block_number) return last_block_number(program);
  if (path.segments.empty()) return 0;
  return profile.key == ForceKey::time ? path.segments.back().t_end : path.segments.back().s_end;
}

/// Lengths and times in files are rounded, and sums of rounded ones drift: 1 um or 1 ms, and a millionth of
/// the whole.
double tolerance(const ForceProfile& profile, double end) {
  if (profile.key == ForceKey::path_length) return 1e-6 + 1e-6 * end;
  return profile.key == ForceKey::time ? 1e-3 + 1e-6 * end : 0;
}

}  // namespace

std::vector<KeySpan> align(const ForceProfile& profile, const Program& program, const Toolpath& path) {
  if (profile.key == ForceKey::block_number) return block_numbers(profile, program, path);
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

void check_cover(const ForceProfile& profile, const Program& program, const Toolpath& path,
                 const std::vector<KeySpan>& keys) {
  const double end = end_of_program(profile, program, path), margin = tolerance(profile, end);
  for (std::size_t i = 0; i < profile.rows.size(); ++i) {
    if (profile.rows[i].key > end + margin)
      fail_row(profile, i,
               fmt::format("{} lies beyond the program, which ends at {}",
                           shown(profile, profile.rows[i].key), shown(profile, end)));
  }
  const Segment *first = nullptr, *last = nullptr;
  double cut_start = 0, cut_end = 0;  // lines and block numbers need not grow along the path
  for (std::size_t i = 0; i < path.segments.size(); ++i) {
    if (!path.segments[i].cutting) continue;
    if (first == nullptr || keys[i].start < cut_start) first = &path.segments[i], cut_start = keys[i].start;
    if (last == nullptr || keys[i].end >= cut_end) last = &path.segments[i], cut_end = keys[i].end;
  }
  if (first == nullptr) return;
  const std::size_t last_row = profile.rows.size() - 1;
  if (profile.rows[0].key > cut_start + margin)
    fail_row(profile, 0,
             fmt::format("{} is the first row, but the program cuts from {} on (line {}): a row there is "
                         "required, with zeros where nothing is cut",
                         shown(profile, profile.rows[0].key), shown(profile, cut_start), first->line));
  if (profile.linear && profile.rows[last_row].key < cut_end - margin)
    fail_row(profile, last_row,
             fmt::format("{} is the last row, but the program cuts until {} (line {}): a row there is "
                         "required for linear interpolation",
                         shown(profile, profile.rows[last_row].key), shown(profile, cut_end), last->line));
}

}  // namespace counterflex
