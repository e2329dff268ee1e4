#include "forces/read/read_selector.hpp"

#include <fmt/format.h>

#include "forces/read/selector_text.hpp"

namespace counterflex::force_file {
namespace {

using namespace toml_file;

constexpr long most_lines = 2'000'000'000, most_tool = 999'999'999;

/// "T3" or 3.
long tool_of(const toml::node& node, const Source& source) {
  if (!node.is_string()) return as_whole(node, {"tool"}, 1, most_tool, source);
  const std::string text = as_text(node, "tool", source);
  const std::optional<long> tool = read_tool(text);
  if (!tool) source.fail(node, fmt::format("tool is \"{}\"; it must be T and its number, as \"T3\"", text));
  return *tool;
}

std::array<long, 2> read_range(const toml::node& node, std::string_view name, long least,
                               const Source& source) {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != 2)
    source.fail(node,
                fmt::format("{} must be the first and the last, as [10, 200], not {}", name, seen(node)));
  const long first = as_whole((*array)[0], {name, 1}, least, most_lines, source);
  const long last = as_whole((*array)[1], {name, 2}, least, most_lines, source);
  if (last < first)
    source.fail((*array)[1], fmt::format("{} ends with {}, before its first, {}", name, last, first));
  return {first, last};
}

}  // namespace

ForceSelector read_selector(const toml::table& table, const Source& source) {
  ForceSelector selector;
  if (const toml::node* tool = table.get("tool")) selector.tool = tool_of(*tool, source);
  if (const toml::node* op = table.get("op")) selector.operation = as_text(*op, "op", source);
  if (const toml::node* lines = table.get("lines")) selector.lines = read_range(*lines, "lines", 1, source);
  if (const toml::node* blocks = table.get("blocks"))
    selector.blocks = read_range(*blocks, "blocks", 0, source);
  return selector;
}

}  // namespace counterflex::force_file
