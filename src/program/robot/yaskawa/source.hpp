#pragma once
/// The lines of a whole Yaskawa job, and how they are written with other positions.
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "program/robot/yaskawa/job.hpp"

namespace counterflex {

/// Where the text of a job has what.
struct JbiLayout {
  Span name;       ///< behind //NAME
  Span positions;  ///< whole lines, from behind //POS to the next section
  Span counts;     ///< the first line ///NPOS
  /// Lists of the lines of those pseudo instructions that hold for positions, and the index of the list of
  /// each position.
  std::vector<std::vector<Span>> conditions;
  std::vector<std::size_t> condition_of;
  std::string attributes;             ///< //INST and its pseudo instructions, without that of local variables
  std::string header;                 ///< of a corrected program
  std::size_t statements = 0;         ///< byte behind NOP and the header
  std::vector<RobotLine> lines;       ///< from there to END
  bool ends = false;                  ///< it has END
  std::size_t first = 0, behind = 0;  ///< in `lines`: from the first MOVL or MOVC to the last one

  std::span<const RobotLine> divided() const { return std::span(lines).subspan(first, behind - first); }
};

struct JbiSource {
  const std::string& text;
  JbiJob job;
  JbiLayout layout;

  /// Index of the position `name`; the number of positions without one.
  std::size_t index_of(const JbiName& name) const;
};

/// `text` must outlive the source. Throws `InputError` in `file`, as `jbi_job`.
JbiSource jbi_source(const std::string& file, const std::string& text);

/// A line with its line end.
Span jbi_whole(const RobotLine& line);

/// The first word of a line in upper case; empty without one.
std::string jbi_head(std::string_view text, const RobotLine& line);

/// The indices of the positions that statements name.
std::set<std::size_t> jbi_positions_in(const JbiSource& source, std::span<const RobotLine> lines);

/// The positions of a job by their indices, with their numbers in it.
using JbiNumbers = std::map<std::size_t, std::uint32_t>;

/// Variables keep their numbers, which the control has; C, BC and EC count from 0.
JbiNumbers jbi_numbers(const JbiSource& source, const std::set<std::size_t>& used);

/// The lines of //POS with these positions, the pseudo instructions that they need, and their counts.
std::string jbi_position_lines(const JbiSource& source, const JbiNumbers& numbers);

/// Statements with these numbers of positions.
std::string jbi_statements(const JbiSource& source, std::span<const RobotLine> lines,
                           const JbiNumbers& numbers);

/// A statement with the values of its positions, and the pseudo instructions that hold for them, in the
/// places of their numbers. Variables keep their numbers, too.
std::string jbi_statement_with_values(const JbiSource& source, const RobotLine& line);

}  // namespace counterflex
