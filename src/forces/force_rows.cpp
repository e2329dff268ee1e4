#include "counterflex/forces/force_rows.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace counterflex {
namespace {

constexpr std::size_t looked_ahead = 4;  // rows

}  // namespace

ForceRows::ForceRows(std::initializer_list<ForceRow> rows) {
  for (const ForceRow& row : rows) push_back(row);
}

ForceRows::ForceRows(const std::vector<ForceRow>& rows) {
  for (const ForceRow& row : rows) push_back(row);
}

ForceRows::ForceRows(const ForceRows& other) {
  for (std::size_t i = 0; i < other.size(); ++i) push_back(other[i]);
}

ForceRows& ForceRows::operator=(const ForceRows& other) {
  return *this = ForceRows(other);
}

void ForceRows::push_back(const ForceRow& row) {
  if (recent_.size() == recent_most) spool_recent();
  Record& record = recent_.emplace_back();
  record.key = row.key;
  std::copy_n(row.F.data(), 6, record.F.begin());
  record.line = row.where.line;
  record.column = row.ends ? -1 - row.where.column : row.where.column;
  all_zero_ = all_zero_ && row.F.isZero(0);
  if (!points_.empty() || !row.point.isZero(0)) {
    points_.resize(size() - 1, Vector3::Zero());
    points_.push_back(row.point);
  }
}

ForceRow ForceRows::operator[](std::size_t i) const {
  const Record& r = record(i);
  return {.key = r.key,
          .F = Eigen::Map<const Vector6>(r.F.data()),
          .where = {r.line, r.column < 0 ? -1 - r.column : r.column},
          .ends = r.column < 0,
          .point = point(i)};
}

// Most profiles have no moments, and their rows are in consecutive lines: this halves the size.
void ForceRows::spool_recent() {
  Spooled kept{.places = false, .line = recent_[0].line, .column = recent_[0].column};
  if (!kept_.empty()) kept.offset = kept_.back().offset + kept_.back().bytes(recent_most);
  const auto is_kept = [](double moment) { return moment != 0 || std::signbit(moment); };
  for (std::size_t i = 0; i < recent_.size(); ++i) {
    const Record& r = recent_[i];
    if (std::any_of(r.F.begin() + 3, r.F.end(), is_kept)) kept.components = 6;
    const auto line = kept.line + static_cast<std::int32_t>(i);
    kept.places = kept.places || r.line != line || r.column != kept.column;
  }
  std::vector<double> numbers;
  numbers.reserve(recent_.size() * kept.numbers());
  for (const Record& r : recent_) {
    numbers.push_back(r.key);
    numbers.insert(numbers.end(), r.F.data(), r.F.data() + kept.components);
    if (kept.places) numbers.push_back(std::bit_cast<double>(std::array{r.line, r.column}));
  }
  spool_.append({reinterpret_cast<const char*>(numbers.data()), kept.bytes(recent_.size())});
  kept_.push_back(kept);
  spooled_ += recent_.size();
  recent_.clear();
}

/// Reads as many stored rows from `first` on as `records` has.
void ForceRows::unpack(const Spooled& kept, std::size_t first, std::vector<Record>& records) const {
  numbers_.resize(records.size() * kept.numbers());
  spool_.read(kept.offset + kept.bytes(first), reinterpret_cast<char*>(numbers_.data()),
              kept.bytes(records.size()));
  const double* at = numbers_.data();
  for (std::size_t i = 0; i < records.size(); ++i) {
    Record& r = records[i];
    r.key = *at++;
    r.F.fill(0);
    std::copy_n(at, kept.components, r.F.begin());
    at += kept.components;
    r.line = kept.line + static_cast<std::int32_t>(first + i);
    r.column = kept.column;
    if (!kept.places) continue;
    const auto place = std::bit_cast<std::array<std::int32_t, 2>>(*at++);
    r.line = place[0];
    r.column = place[1];
  }
}

const ForceRows::Record& ForceRows::spooled_record(std::size_t i) const {
  const std::size_t number = i / block_rows;
  Block& block = blocks_[number % blocks_held];
  if (block.number != number) {
    block.records.resize(block_rows);
    block.number = static_cast<std::size_t>(-1);  // a partly read block is invalid
    const std::size_t first = number * block_rows;
    unpack(kept_[first / recent_most], first % recent_most, block.records);
    block.number = number;
  }
  return block.records[i % block_rows];
}

std::size_t ForceRows::beyond(double key) const {
  if (near_ == 0 || record(near_ - 1).key <= key)
    for (std::size_t i = near_; i <= std::min(size(), near_ + looked_ahead); ++i)
      if (i == size() || record(i).key > key) return near_ = i;
  std::size_t first = 0, count = size();
  while (count > 0) {
    const std::size_t half = count / 2;
    if (record(first + half).key <= key) {
      first += half + 1;
      count -= half + 1;
    } else {
      count = half;
    }
  }
  return near_ = first;
}

}  // namespace counterflex
