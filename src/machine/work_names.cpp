#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "counterflex/machine/machine.hpp"

namespace counterflex {
namespace {

std::optional<int> digits(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size() && text[0] != '-';
  return whole ? std::optional(value) : std::nullopt;
}

bool within(std::optional<int> value, int least, int most) {
  return value && *value >= least && *value <= most;
}

/// Removes blanks and converts to upper case.
std::string closed_up(std::string_view text) {
  std::string name;
  for (const char c : text)
    if (c != ' ') name += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return name;
}

bool stands_alone(std::string_view name) {
  constexpr std::array<std::string_view, 3> with_point{"G59.1", "G59.2", "G59.3"};
  if (std::find(with_point.begin(), with_point.end(), name) != with_point.end()) return true;
  if (name.empty() || name[0] != 'G') return false;
  const auto number = digits(name.substr(1));
  return within(number, 54, 59) || within(number, 500, 599);
}

/// Frames of robots: "UF 5" of FANUC, "USER 3" of Yaskawa, "BASE_DATA[1]" of KUKA, its "$BASE" with numbers
/// and "$BASE 1", the first one that is computed. `name` is closed up.
std::optional<std::string> robot_frame_name(std::string_view name) {
  constexpr std::string_view frame = "UF", user = "USER", base = "BASE_DATA[", active = "$BASE";
  constexpr int most = 99;
  if (name == active || name == "$NULLFRAME") return std::string(name);
  if (name.starts_with(active)) {
    const auto number = digits(name.substr(active.size()));
    if (number && *number > 0) return fmt::format("{} {}", active, *number);
  }
  if (name.starts_with(frame)) {
    const auto number = digits(name.substr(frame.size()));
    if (within(number, 0, most)) return "UF " + std::to_string(*number);
  }
  if (name.starts_with(user)) {
    const auto number = digits(name.substr(user.size()));
    if (within(number, 1, most)) return "USER " + std::to_string(*number);
  }
  if (!name.starts_with(base) || !name.ends_with(']')) return std::nullopt;
  const auto number = digits(name.substr(base.size(), name.size() - base.size() - 1));
  return within(number, 1, most) ? std::optional("BASE_DATA[" + std::to_string(*number) + ']') : std::nullopt;
}

bool is_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_';
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// A work object of ABB, a variable of KUKA or URScript: a word that is not like "G60".
bool is_name_of_frame(std::string_view text) {
  if (text.size() < 2 || !is_letter(text[0])) return false;
  if ((text[0] == 'G' || text[0] == 'g') && is_digit(text[1])) return false;
  return std::all_of(text.begin(), text.end(), [](char c) { return is_letter(c) || is_digit(c); });
}

}  // namespace

std::optional<std::string> work_offset_name(std::string_view text) {
  const std::string name = closed_up(text);
  if (stands_alone(name)) return name;
  if (auto frame = robot_frame_name(name)) return frame;
  const std::size_t p = name.find('P');
  if (is_name_of_frame(text)) return std::string(text);
  if (p == std::string::npos) return std::nullopt;
  const auto page = digits(std::string_view(name).substr(p + 1));
  const std::string group = name.substr(0, p);
  const bool known = (group == "G54.1" && within(page, 1, 300)) || (group == "G154" && within(page, 1, 99));
  if (!known) return std::nullopt;
  return "G54.1 P" + std::to_string(*page);  // as the reader of programs names them
}

}  // namespace counterflex
