#include "counterflex/program/line_lengths.hpp"

#include "program/line_length.hpp"

namespace counterflex {
namespace {

constexpr std::size_t near_percent = 90;

}  // namespace

LineLengths line_lengths(std::string_view text, std::string_view dialect) {
  LineLengths lengths;
  const Dialect* control = find_dialect(dialect);
  if (control == nullptr || control->line_limit == 0) return lengths;
  lengths.limit = control->line_limit;
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = text.find('\n');
    std::string_view bytes = text.substr(0, end);
    if (bytes.ends_with('\r')) bytes.remove_suffix(1);
    // Only what is long with its comments can be long without them.
    const std::size_t length =
        bytes.size() > lengths.longest || 100 * bytes.size() > near_percent * lengths.limit
            ? counted_length(*control, bytes)
            : 0;
    if (length > lengths.longest) lengths.longest = length, lengths.longest_line = line;
    if (100 * length > near_percent * lengths.limit && lengths.near++ == 0) lengths.first_near = line;
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  return lengths;
}

}  // namespace counterflex
