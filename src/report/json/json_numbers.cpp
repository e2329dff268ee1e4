#include "report/json/json_numbers.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace counterflex {

namespace {

bool plain(const Json& value) {
  return !value.is_structured() || value.empty();
}

void write_list(const Json& list, std::string& out) {
  const char* separator = "";
  out += '[';
  for (const Json& value : list) {
    out.append(separator).append(on_one_line(value));
    separator = ", ";
  }
  out += ']';
}

void write(const Json& value, std::size_t indent, std::string& out) {
  if (plain(value)) {
    out += on_one_line(value);
    return;
  }
  if (value.is_array() && std::all_of(value.begin(), value.end(), plain)) {
    write_list(value, out);
    return;
  }
  out += value.is_array() ? '[' : '{';
  const char* separator = "\n";
  for (const auto& item : value.items()) {
    out.append(separator).append(indent + 2, ' ');
    if (value.is_object()) out.append(on_one_line(item.key())).append(": ");
    write(item.value(), indent + 2, out);
    separator = ",\n";
  }
  out.append("\n").append(indent, ' ');
  out += value.is_array() ? ']' : '}';
}

}  // namespace

Json significant(double value, int digits) {
  if (!std::isfinite(value)) return nullptr;
  return *read_number(fmt::format("{:.{}e}", value, digits - 1));
}

std::string on_one_line(const Json& document) {
  constexpr bool only_ascii = true;
  std::string text = document.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (without_controls(text) == text) return text;
  return document.dump(-1, ' ', only_ascii, Json::error_handler_t::replace);
}

std::string dump(const Json& document) {
  std::string text;
  write(document, 0, text);
  return text + "\n";
}

}  // namespace counterflex
