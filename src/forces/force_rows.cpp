#include "counterflex/forces/force_rows.hpp"

#include <algorithm>

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
  if (recent_.size() == recent_most) {
    static_assert(std::is_trivially_copyable_v<Record>);
    spool_.append({reinterpret_cast<const char*>(recent_.data()), recent_.size() * sizeof(Record)});
    spooled_ += recent_.size();
    recent_.clear();
  }
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

const ForceRows::Record& ForceRows::spooled_record(std::size_t i) const {
  const std::size_t number = i / block_rows;
  Block& block = blocks_[number % blocks_held];
  if (block.number != number) {
    block.records.resize(block_rows);
    block.number = static_cast<std::size_t>(-1);  // what is half read is no block
    spool_.read(number * block_rows * sizeof(Record), reinterpret_cast<char*>(block.records.data()),
                block_rows * sizeof(Record));
    block.number = number;
  }
  return block.records[i % block_rows];
}

bool ForceRows::is_first_beyond(std::size_t i, double key) const {
  return (i == size() || record(i).key > key) && (i == 0 || record(i - 1).key <= key);
}

std::size_t ForceRows::beyond(double key) const {
  for (std::size_t i = near_; i <= std::min(size(), near_ + looked_ahead); ++i)
    if (is_first_beyond(i, key)) return near_ = i;
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
