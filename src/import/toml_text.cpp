#include "import/toml_text.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <filesystem>

#include "counterflex/files/text.hpp"

namespace counterflex::import {

void fail(const Location& where, const std::string& message) {
  throw InputError(ErrorKind::machine_or_force, where, message);
}

double read_usable(std::string_view text, const Location& at, const std::string& what) {
  constexpr double largest = 1e9;
  const auto value = read_number(text);
  if (!value) fail(at, fmt::format("{} is '{}'; it must be a finite number", what, without_controls(text)));
  if (!(std::abs(*value) <= largest))
    fail(at, fmt::format("{} is {}; it must be at most 1e9 in size", what, without_controls(text)));
  return *value;
}

std::string number(double value) {
  std::string text = format_fixed(value, 12);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string list_mm(const Vector3& p) {
  return fmt::format("[{}, {}, {}]", number(p.x() / mm), number(p.y() / mm), number(p.z() / mm));
}

std::string list_deg(const Vector3& angles) {
  return fmt::format("[{}, {}, {}]", number(angles.x() / deg), number(angles.y() / deg),
                     number(angles.z() / deg));
}

std::string comment_text(std::string_view text) {
  return without_controls(utf8_of_bytes(text));
}

std::string toml_string(std::string_view text) {
  std::string result = "\"";
  for (const char c : comment_text(text)) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string program_text(const std::string& dialect, const std::string& units) {
  std::string text = fmt::format("\n[program]\ndialect = \"{}\"\n", dialect);
  if (!units.empty()) text += fmt::format("units = \"{}\"\n", units);
  return text;
}

std::string file_name(const std::string& file) {
  return comment_text(std::filesystem::path(file).filename().generic_string());
}

std::string file_stem(const std::string& file) {
  return comment_text(std::filesystem::path(file).stem().generic_string());
}

std::string identifier(std::string_view text) {
  std::string result;
  for (const unsigned char c : text)
    result += (c < 128 && std::isalnum(c) != 0) || c == '_' || c == '-' ? static_cast<char>(c) : '_';
  return result;
}

}  // namespace counterflex::import
