#include "forces/read/selector_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <variant>

#include "counterflex/files/csv_text.hpp"
#include "counterflex/files/text.hpp"

namespace counterflex {

std::optional<long> read_tool(std::string_view text) {
  const std::optional<long> tool = read_tool_number(text);
  return tool && *tool > 0 ? tool : std::nullopt;
}

std::string folded(std::string_view operation) {
  std::string text(csv::trimmed(operation));
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

std::string shown(const ForceSelector& selector) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  const auto add_range = [&](const char* what, const std::optional<std::array<long, 2>>& range) {
    if (range) add(fmt::format("{} {} to {}", what, (*range)[0], (*range)[1]));
  };
  if (selector.tool) add(fmt::format("tool T{}", *selector.tool));
  if (selector.operation) add(fmt::format("operation '{}'", *selector.operation));
  add_range("lines", selector.lines);
  add_range("blocks", selector.blocks);
  return text;
}

bool is_section(const ForceRule& rule) {
  return std::holds_alternative<CutResponse>(rule.content);
}

std::string place_of(const ForceRule& rule, const Location& where) {
  if (where.file.empty()) return rule.name;
  const std::string place = fmt::format("{}:{}", where.file, where.line);
  return is_section(rule) ? fmt::format("{} ({})", rule.name, place) : place;
}

std::string_view shown(ForceRank rank) {
  constexpr std::array<std::string_view, 4> names = {"places", "operations", "tools", "the whole program"};
  return names[static_cast<std::size_t>(rank)];
}

void fail_rule(const ForceRule& rule, const Location& where, const std::string& message) {
  const bool option = where.file.empty();
  throw InputError(option ? ErrorKind::usage : ErrorKind::machine_or_force, where,
                   option || is_section(rule) ? fmt::format("{}: {}", rule.name, message) : message);
}

void fail_rule(const ForceRule& rule, const std::string& message) {
  fail_rule(rule, rule.where, message);
}

}  // namespace counterflex
