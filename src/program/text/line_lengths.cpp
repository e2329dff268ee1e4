#include <algorithm>

#include "counterflex/program/overview.hpp"
#include "program/text/line_length.hpp"

namespace counterflex {
namespace {

constexpr std::size_t near_percent = 90;

bool is_near(std::size_t length, std::size_t limit) {
  return 100 * length > near_percent * limit;
}

void add_line(LineLengths& lengths, const Dialect& control, std::string_view bytes) {
  if (bytes.ends_with('\r')) bytes.remove_suffix(1);
  const int line = ++lengths.lines;
  // A line that is short with its comments is short without them.
  if (bytes.size() <= lengths.longest && !is_near(bytes.size(), lengths.limit)) return;
  const std::size_t length = counted_length(control, bytes);
  if (length > lengths.longest) lengths.longest = length, lengths.longest_line = line;
  if (is_near(length, lengths.limit) && lengths.near++ == 0) lengths.first_near = line;
}

}  // namespace

void add_lines(LineLengths& lengths, std::string_view text, std::string_view dialect) {
  const Dialect* control = find_dialect(dialect);
  if (control == nullptr || control->line_limit == 0) return;
  lengths.limit = control->line_limit;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    add_line(lengths, *control, text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

LineLengths line_lengths(std::string_view text, std::string_view dialect) {
  LineLengths lengths;
  add_lines(lengths, text, dialect);
  return lengths;
}

}  // namespace counterflex
