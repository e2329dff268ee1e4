#include "program/detect/other_machines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <set>

#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

bool has_word(std::string_view text, std::string_view word) {
  const auto same = [](char a, char b) { return upper(a) == b; };
  for (auto at = text.begin();; ++at) {
    at = std::search(at, text.end(), word.begin(), word.end(), same);
    if (at == text.end()) return false;
    const auto end = at + static_cast<std::ptrdiff_t>(word.size());
    if ((at == text.begin() || !is_letter(at[-1])) && (end == text.end() || !is_letter(*end))) return true;
  }
}

/// Signs of the machine in a program, independent of the dialect.
struct Signs {
  std::array<std::size_t, 26> words{};  ///< by letter
  std::set<int> g_codes{};
  std::size_t beam_switches = 0;  ///< M3, M4 and M5
  bool long_tool_number = false;  ///< T0101: tool number and its offset
  bool changes_tool = false;      ///< M6
  bool spindle_limit = false;     ///< G50 or G92 with S in one line
  bool heats = false;             ///< M104, M109, M140 or M190
  bool has_laser_comment = false, has_laser_on_comment = false, has_plasma_comment = false;

  std::size_t count(char letter) const { return words[static_cast<std::size_t>(letter - 'A')]; }
};

struct LineSigns {
  bool limits = false, speed = false;
};

void take_word(char letter, std::string_view digits, Signs& signs, LineSigns& line) {
  ++signs.words[static_cast<std::size_t>(letter - 'A')];
  if (letter == 'S') line.speed = true;
  if (letter == 'T') signs.long_tool_number = signs.long_tool_number || digits.size() == 4;
  if (letter != 'G' && letter != 'M') return;
  double value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const int code = static_cast<int>(std::clamp(value, -1.0, 9999.0));
  if (letter == 'G') {
    signs.g_codes.insert(code);
    line.limits = line.limits || code == 50 || code == 92;
    return;
  }
  signs.beam_switches += code >= 3 && code <= 5;
  signs.changes_tool = signs.changes_tool || code == 6;
  signs.heats = signs.heats || code == 104 || code == 109 || code == 140 || code == 190;
}

void take_comment(std::string_view comment, Signs& signs) {
  signs.has_laser_comment = signs.has_laser_comment || has_word(comment, "LASER");
  signs.has_laser_on_comment =
      signs.has_laser_on_comment || (has_word(comment, "LASER") && has_word(comment, "ON"));
  signs.has_plasma_comment = signs.has_plasma_comment || has_word(comment, "PLASMA");
}

bool is_of_number(char c) {
  return is_digit(c) || c == '.' || c == '+' || c == '-';
}

void take_line(std::string_view line, Signs& signs) {
  LineSigns of_line;
  for (std::size_t i = 0; i < line.size();) {
    if (line[i] == ';') return take_comment(line.substr(i), signs);
    if (line[i] == '(') {
      const std::size_t end = std::min(line.find(')', i), line.size());
      take_comment(line.substr(i, end - i), signs);
      i = end + 1;
    } else if (is_letter(line[i])) {
      std::size_t end = i + 1;
      while (end < line.size() && is_of_number(line[end])) ++end;
      const bool name = end < line.size() && is_letter(line[end]) && end == i + 1;
      if (!name && end > i + 1) take_word(upper(line[i]), line.substr(i + 1, end - i - 1), signs, of_line);
      while (name && end < line.size() && is_letter(line[end])) ++end;
      i = end;
    } else {
      ++i;
    }
  }
  signs.spindle_limit = signs.spindle_limit || (of_line.limits && of_line.speed);
}

std::string lathe(const Signs& s) {
  const bool radial = s.count('X') > 0 && s.count('Z') > 0 && s.count('Y') == 0;
  if (!radial) return {};
  if (s.g_codes.contains(96)) return "a lathe program (G96 and no Y)";
  if (s.long_tool_number && !s.changes_tool) return "a lathe program (T with four digits and no Y)";
  if (s.spindle_limit && s.g_codes.contains(50)) return "a lathe program (G50 S and no Y)";
  const bool arcs = s.g_codes.contains(2) || s.g_codes.contains(3);
  if (arcs && s.count('K') > 0 && !s.g_codes.contains(18))
    return "a lathe program (arcs with K, no G18 and no Y)";
  return {};
}

std::string beam(const Signs& s) {
  constexpr std::size_t many = 6;  // a milling spindle is switched once or twice per tool
  const bool switched = s.beam_switches >= many && !s.changes_tool;
  if (s.has_laser_on_comment || (s.has_laser_comment && (switched || s.count('Z') == 0)))
    return "a laser program (named in comments)";
  if (s.has_plasma_comment && (switched || s.count('Z') == 0)) return "a plasma program (named in comments)";
  const bool flat = s.count('X') > 0 && s.count('Y') > 0 && s.count('Z') == 0;
  if (flat && switched) return "a laser or plasma program (M3 and M5 for each cut, and no Z)";
  return {};
}

std::string printer(const Signs& s) {
  return s.heats && s.count('E') > 0 ? "a program of a 3D printer (it heats, and E feeds the filament)" : "";
}

/// Recognises programs by their beginning.
std::string other_control(std::string_view text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  if (line.starts_with('$') && line.find('%') != std::string_view::npos)
    return "an Okuma program ($...% at its beginning)";
  const std::string_view next = text.substr(std::min(line.size() + 1, text.size()));
  if (line.starts_with("%PM") && next.starts_with("N9"))
    return "a Philips program (%PM and N9... at its beginning)";
  return {};
}

}  // namespace

std::string other_machine(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  if (std::string control = other_control(text); !control.empty()) return control;
  Signs signs;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    take_line(text.substr(0, end), signs);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  for (const auto& machine : {lathe, beam, printer})
    if (std::string found = machine(signs); !found.empty()) return found;
  return {};
}

}  // namespace counterflex
