#include "report/json/json_numbers.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace counterflex {

namespace {

bool plain(const Json& value) {
  return !value.is_structured() || value.empty();
}

std::string text_of(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void write_list(const Json& list, std::string& out) {
  const char* separator = "";
  out += '[';
  for (const Json& value : list) {
    out.append(separator).append(text_of(value));
    separator = ", ";
  }
  out += ']';
}

void write(const Json& value, std::size_t indent, std::string& out) {
  if (plain(value)) {
    out += text_of(value);
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
    if (value.is_object()) out.append(text_of(item.key())).append(": ");
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

std::string dump(const Json& document) {
  std::string text;
  write(document, 0, text);
  return text + "\n";
}

}  // namespace counterflex
