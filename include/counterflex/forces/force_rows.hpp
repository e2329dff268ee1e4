#pragma once
/// The rows of a force profile, of which there may be more than memory should hold.
#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <vector>

#include "counterflex/files/files.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {

/// The place of a row in its file; line and column count from 1, columns in bytes.
struct RowPlace {
  int line = 0;
  int column = 0;
};

struct ForceRow {
  double key = 0;               ///< line, N, m or s; of a point nothing
  Vector6 F = Vector6::Zero();  ///< on the tool, axes of the profile's frame
  RowPlace where{};
  bool ends = false;                ///< no wrench: the profile covers nothing until the next row
  Vector3 point = Vector3::Zero();  ///< (m)
};

/// Rows, first to last. Beyond some thousands they are kept in a temporary file, of which the blocks asked
/// for last are in memory: reading in order costs little. Points, which logs alone have, stay in memory.
/// Reading changes what is in memory: one thread at a time. Members throw as `Spool` does.
class ForceRows {
 public:
  ForceRows() = default;
  ForceRows(std::initializer_list<ForceRow> rows);
  explicit ForceRows(const std::vector<ForceRow>& rows);
  ForceRows(const ForceRows& other);
  ForceRows(ForceRows&&) noexcept = default;
  ForceRows& operator=(const ForceRows& other);
  ForceRows& operator=(ForceRows&&) noexcept = default;
  ~ForceRows() = default;

  void push_back(const ForceRow& row);

  std::size_t size() const { return spooled_ + recent_.size(); }
  bool empty() const { return size() == 0; }
  bool all_zero() const { return all_zero_; }  ///< no row has a wrench

  ForceRow operator[](std::size_t i) const;
  ForceRow front() const { return (*this)[0]; }
  ForceRow back() const { return (*this)[size() - 1]; }
  double key(std::size_t i) const { return record(i).key; }
  Vector6 wrench(std::size_t i) const { return Eigen::Map<const Vector6>(record(i).F.data()); }
  bool ends(std::size_t i) const { return record(i).column < 0; }
  Vector3 point(std::size_t i) const { return points_.empty() ? Vector3(Vector3::Zero()) : points_[i]; }

  /// The first row whose key is greater, or `size()`; keys must not decrease. Costs little where keys that
  /// are asked for follow each other.
  std::size_t beyond(double key) const;

  /// From row to row; gives rows by value.
  class Iterator {
   public:
    Iterator(const ForceRows& rows, std::size_t i) : rows_(&rows), i_(i) {}
    ForceRow operator*() const { return (*rows_)[i_]; }
    Iterator& operator++() {
      ++i_;
      return *this;
    }
    bool operator!=(const Iterator& other) const { return i_ != other.i_; }

   private:
    const ForceRows* rows_;
    std::size_t i_;
  };
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size()}; }

 private:
  struct Record {
    double key = 0;
    std::array<double, 6> F{};
    std::int32_t line = 0;
    std::int32_t column = 0;  ///< negative, and one less: the row ends the cover
  };
  static constexpr std::size_t block_rows = 1024, blocks_held = 4, recent_most = 8 * block_rows;
  /// How `recent_most` rows are kept in the spool: as so many numbers each.
  struct Spooled {
    std::size_t offset = 0;             ///< of the first number in the spool (bytes)
    std::size_t components = 3;         ///< of the wrench: moments are kept where there is one
    bool places = true;                 ///< are kept: rows do not just follow each other, line by line
    std::int32_t line = 0, column = 0;  ///< of the first row

    std::size_t numbers() const { return 1 + components + (places ? 1 : 0); }
    std::size_t bytes(std::size_t rows) const { return rows * numbers() * sizeof(double); }
  };
  struct Block {
    std::size_t number = static_cast<std::size_t>(-1);
    std::vector<Record> records{};
  };

  const Record& record(std::size_t i) const {
    if (i >= spooled_) return recent_[i - spooled_];
    const Block& block = blocks_[i / block_rows % blocks_held];
    return block.number == i / block_rows ? block.records[i % block_rows] : spooled_record(i);
  }
  const Record& spooled_record(std::size_t i) const;
  void spool_recent();
  void unpack(const Spooled& kept, std::size_t first, std::vector<Record>& records) const;

  std::vector<Record> recent_;  ///< all rows, or those behind the spooled ones
  std::vector<Vector3> points_;
  Spool spool_;
  std::vector<Spooled> kept_;
  std::size_t spooled_ = 0;  ///< rows, whole blocks
  bool all_zero_ = true;
  mutable std::array<Block, blocks_held> blocks_;
  mutable std::vector<double> numbers_;  ///< of a block that is read
  mutable std::size_t near_ = 0;         ///< the last answer of `beyond`
};

}  // namespace counterflex
