#include "identify/read/repeat.hpp"

#include "counterflex/files/text.hpp"

namespace counterflex::measurement_file {

RepeatedReading read_repeat(const Table& table, const std::string& session) {
  RepeatedReading row{session, "", {table.where().file, table.where().line, 1}};
  const csv::Field* place = table.text("place");
  if (place == nullptr || place->text.empty())
    table.fail("place", "the row has no place; give readings at the same place the same name");
  row.place = without_controls(place->text);
  const bool has_reading = table.is_filled("reading");
  row.is_position = table.is_filled("x") || table.is_filled("y") || table.is_filled("z");
  if (row.is_position == has_reading)
    table.fail("", "a repeat needs either x, y, z of a tracker or a reading of a gauge");
  row.value = row.is_position ? Vector3(table.value("x"), table.value("y"), table.value("z"))
                              : Vector3(table.value("reading"), 0, 0);
  return row;
}

}  // namespace counterflex::measurement_file
