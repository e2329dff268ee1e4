#pragma once
/// Where the rows of a profile act on a path.
#include <optional>
#include <vector>

#include "counterflex/forces/forces.hpp"

namespace counterflex {

/// The profile's key over a segment: a range for lengths and times, one value for lines and block numbers.
struct KeySpan {
  double start = 0;
  double end = 0;
};

/// The key of every segment, in SI; meaningless for rapids. `block_number` is N of the previous moves, then
/// of these. Throws `InputError` (ErrorKind::machine_or_force) if the program lacks the block number or the
/// feed that the key needs.
std::vector<KeySpan> align(const ForceProfile& profile, const Program& program, const Toolpath& path,
                           std::optional<long>& block_number);

/// The place in its file of a row of a profile, counted from 0.
Location place_of_row(const ForceProfile& profile, std::size_t row);

/// Throws (ErrorKind::machine_or_force) at a row of a profile, counted from 0. The message names the row.
[[noreturn]] void fail_row(const ForceProfile& profile, std::size_t row, const std::string& message);

}  // namespace counterflex
