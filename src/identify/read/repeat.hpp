#pragma once
/// Rows of kind repeat.
#include "counterflex/identify/measurements.hpp"
#include "identify/read/table.hpp"

namespace counterflex::measurement_file {

/// The table's current row: a place, and either a position or a reading of a gauge.
RepeatedReading read_repeat(const Table& table, const std::string& session);

}  // namespace counterflex::measurement_file
