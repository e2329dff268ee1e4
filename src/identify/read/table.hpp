#pragma once
/// The rows of a CSV table whose columns are quantities.
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "identify/read/columns.hpp"
#include "identify/read/description.hpp"

namespace counterflex::measurement_file {

/// Reads row by row. With a description it skips the lines before the row of names, checks the row of units,
/// and adds the columns of a second table. Errors throw `InputError` with line and column.
class Table {
 public:
  /// Reads the row of names. `text` is the file and outlives the table.
  Table(std::string_view text, const std::string& file, const Description& description,
        const Machine& machine);

  /// Goes to the next row. False at the end.
  bool next();

  /// The current row.
  const Location& where() const { return where_; }

  /// Whether there is such a column, or a constant.
  bool has(std::string_view name) const { return columns_.find(name) != columns_.end(); }
  /// Whether the current row has a text in it.
  bool is_filled(std::string_view name) const;
  /// Whether the unit of a column that is there is one of angles.
  bool is_angle(std::string_view name) const { return columns_.find(name)->second.is_angle; }

  /// SI; the column is there.
  double value(std::string_view name) const;
  double value_or(std::string_view name, double otherwise) const {
    return is_filled(name) ? value(name) : otherwise;
  }
  /// The field of a column of texts; null without one.
  const csv::Field* text(std::string_view name) const;

  /// The place of a column in the current row, or the row's beginning.
  Location place_of(std::string_view name) const;
  [[noreturn]] void fail(std::string_view name, const std::string& message) const;

 private:
  bool next_line(std::string_view& line);
  void read_names(const std::vector<csv::Field>& fields);
  void check_units(std::string_view line) const;
  void read_states();
  std::vector<csv::Field> split(std::string_view line) const;

  std::string_view rest_;
  Location where_;
  const Description& description_;
  const Machine& machine_;
  char separator_ = ',';
  std::size_t count_ = 0;  ///< of columns of the table itself
  Columns columns_;
  std::vector<csv::Field> fields_;  ///< of the current row; those of the second table behind the others
  std::string states_text_;         ///< of the second table
  std::vector<std::vector<csv::Field>> states_;
  std::map<std::string, std::size_t, std::less<>> state_of_;  ///< row of the second table by point
  bool states_have_decimal_commas_ = false;
  std::size_t row_ = 0;  ///< rows that were read
};

}  // namespace counterflex::measurement_file
