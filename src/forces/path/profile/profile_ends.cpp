#include "forces/path/profile/profile_ends.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/geometry/types.hpp"
#include "forces/path/profile/position_log.hpp"
#include "forces/path/profile/profile_cover.hpp"
#include "forces/read/csv_header.hpp"

namespace counterflex {
namespace {

std::string shown_key(const ForceProfile& profile, double key) {
  return fmt::format("{} {:.9g}", csv::key_name(profile.key), key * csv::shown_per_si(profile.key));
}

}  // namespace

void ProgramEnds::add(const Program& window, const Toolpath& of_window) {
  for (const Move& move : window.moves)
    last_block_number = std::max(last_block_number, move.block_number.value_or(0));
  if (!window.moves.empty()) last_line = window.moves.back().line;
  newlines += std::count(window.text.begin(), window.text.end(), '\n');
  if (!window.text.empty()) ends_in_line = window.text.back() != '\n';
  file_lines = window.expansion.file_lines;
  path = of_window.end;
}

double ProgramEnds::last(ForceKey key) const {
  switch (key) {
    case ForceKey::line:
      if (file_lines > 0) return static_cast<double>(file_lines);
      return static_cast<double>(std::max(newlines + (ends_in_line ? 1 : 0), last_line));
    case ForceKey::block_number:
      return static_cast<double>(last_block_number);
    case ForceKey::path_length:
      return path.s;
    default:
      return path.t;
  }
}

void ProfileEnds::add(const KeySpan& keys, const Segment& cut) {
  // Lines and block numbers need not grow along the path.
  if (!first_ || keys.start < first_->key) first_ = {keys.start, cut.line};
  if (!last_ || keys.end >= last_->key) last_ = {keys.end, cut.line};
}

void ProfileEnds::refuse_rows_beyond(const ProgramEnds& program) const {
  const double last_key = program.last(profile_.key);
  const ForceRows& rows = profile_.rows;
  const std::size_t row = rows.beyond(last_key + key_margin(profile_, last_key));
  if (row < rows.size())
    fail_row(profile_, row,
             fmt::format("{} is beyond the end of the program at {}", shown_key(profile_, rows.key(row)),
                         shown_key(profile_, last_key)));
}

void ProfileEnds::refuse_missing_ends(const ProgramEnds& program) const {
  if (!first_) return;
  const double margin = reach(profile_, program.last(profile_.key));
  const ForceRows& rows = profile_.rows;
  const auto row_name = [&](const ForceRow& row) {
    return profile_.within ? shown_point(row.point) : shown_key(profile_, row.key);
  };
  // A log has no path lengths.
  const auto end_name = [&](const Cut& cut, const ForceRow& row, std::string_view side) {
    return profile_.within ? fmt::format("{:.4g} mm {} it", std::abs(cut.key - row.key) / mm, side)
                           : shown_key(profile_, cut.key);
  };
  if (rows.front().key > first_->key + margin)
    fail_row(profile_, 0,
             fmt::format("{} is the first row, but the program cuts from {} on (line {}): a row there is "
                         "required, with zeros where nothing is cut",
                         row_name(rows.front()), end_name(*first_, rows.front(), "before"), first_->line));
  if (profile_.linear && !rows.back().ends && rows.back().key < last_->key - margin)
    fail_row(profile_, rows.size() - 1,
             fmt::format("{} is the last row, but the program cuts until {} (line {}): a row there is "
                         "required for linear interpolation",
                         row_name(rows.back()), end_name(*last_, rows.back(), "behind"), last_->line));
}

}  // namespace counterflex
