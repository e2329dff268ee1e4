#include "toml/source.hpp"

#include <algorithm>
#include <utility>

#include "toml/depth.hpp"

namespace counterflex::toml_file {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

bool continues_code_point(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

}  // namespace

Source::Source(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {
  if (text_.starts_with(byte_order_mark)) text_.remove_prefix(byte_order_mark.size());
  line_starts_.push_back(0);
  for (std::size_t i = 0; i < text_.size(); ++i)
    if (text_[i] == '\n') line_starts_.push_back(i + 1);
}

toml::table Source::parse() const {
  if (const auto deep = find_too_deep(text_)) {
    const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), deep->offset);
    const auto column = static_cast<int>(deep->offset - *(after - 1)) + 1;
    throw InputError(ErrorKind::machine_or_force,
                     {file_, static_cast<int>(after - line_starts_.begin()), column}, deep->what);
  }
  try {
    return toml::parse(text_);
  } catch (const toml::parse_error& error) {
    std::string message(error.description());
    constexpr std::string_view prefix = "Error while parsing ";
    if (message.starts_with(prefix)) message.replace(0, prefix.size(), "bad TOML in ");
    fail(error.source(), message);
  }
}

Location Source::at(const toml::source_region& region) const {
  const auto line = static_cast<std::size_t>(region.begin.line);
  if (line == 0 || line > line_starts_.size()) return {file_, static_cast<int>(line), 1};
  const std::size_t start = line_starts_[line - 1];
  std::size_t i = start;
  for (unsigned column = 1; column < region.begin.column && i < text_.size(); ++column) {
    ++i;
    while (i < text_.size() && continues_code_point(text_[i])) ++i;
  }
  return {file_, static_cast<int>(line), static_cast<int>(i - start) + 1};
}

void Source::fail(const toml::source_region& region, const std::string& message) const {
  throw InputError(ErrorKind::machine_or_force, at(region), message);
}

void Source::fail(const toml::node& node, const std::string& message) const {
  fail(node.source(), message);
}

void Source::fail(const toml::key& key, const std::string& message) const {
  fail(key.source(), message);
}

void Source::fail_at_start(const std::string& message) const {
  throw InputError(ErrorKind::machine_or_force, {file_, 1, 1}, message);
}

bool before(const toml::source_region& a, const toml::source_region& b) {
  return std::pair(a.begin.line, a.begin.column) < std::pair(b.begin.line, b.begin.column);
}

const toml::key& key_of(const toml::table& table, std::string_view name) {
  return table.find(name)->first;
}

}  // namespace counterflex::toml_file
