#include "counterflex/files/csv_text.hpp"

#include <algorithm>

namespace counterflex::csv {
namespace {

bool blank(char c) {
  return c == ' ' || c == '\t';
}

/// The end of the quotes at `begin`, or `begin` if the field is not quoted.
std::size_t end_of_quotes(std::string_view line, std::size_t begin) {
  while (begin < line.size() && blank(line[begin])) ++begin;
  if (begin == line.size() || line[begin] != '"') return begin;
  const std::size_t end = line.find('"', begin + 1);
  return end == std::string_view::npos ? begin : end + 1;
}

std::string_view unquoted(std::string_view text) {
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return quoted ? trimmed(text.substr(1, text.size() - 2)) : text;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<Field> split(std::string_view line, int first_column, char separator) {
  std::vector<Field> fields;
  for (std::size_t begin = 0;;) {
    const std::size_t end = std::min(line.find(separator, end_of_quotes(line, begin)), line.size());
    const std::string_view raw = line.substr(begin, end - begin), text = unquoted(trimmed(raw));
    const std::size_t indent = text.empty() ? 0 : static_cast<std::size_t>(text.data() - raw.data());
    fields.push_back({text, first_column + static_cast<int>(begin + indent)});
    if (end == line.size()) return fields;
    begin = end + 1;
  }
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

void fail(const Location& where, const std::string& message) {
  throw InputError(ErrorKind::machine_or_force, where, message);
}

}  // namespace counterflex::csv
