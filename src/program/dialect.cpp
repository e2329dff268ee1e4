#include "program/dialect.hpp"

#include <array>

#include "program/klartext_lex.hpp"
#include "program/siemens_lex.hpp"

namespace counterflex {
namespace {

constexpr Dialect linuxcnc{.name = "linuxcnc",
                           .family = linuxcnc_family,
                           .line_limit = 255,
                           .feed_mode_ends_feed = true,
                           .feed_before_unit = true,
                           .number_anywhere = false,
                           .o_words = true};

constexpr Dialect grbl{.name = "grbl",
                       .family = grbl_family,
                       .line_limit = 80,
                       .limit_counts_comments = false,
                       .g61_is_exact_stop = false,
                       .parentheses_nest = true,
                       .comments_may_stay_open = true};

constexpr Dialect shop_control(std::string_view name, unsigned family) {
  return {.name = name,
          .family = family,
          .semicolon_comments = false,
          .motion_ends_with_g80 = false,
          .tool_change_moves_axes = true,
          .integer_words_doubtful = true,
          .g61_is_exact_stop = true,
          .h_and_d_stand_alone = true,
          .dwell_takes_axis_words = true,
          .block_delete_numbers = true,
          .reference_beside_motion = true,
          .macro_words = true,
          .parentheses_nest = true};
}

constexpr Dialect fanuc = shop_control("fanuc", fanuc_family);
constexpr Dialect haas = shop_control("haas", haas_family);

constexpr Dialect mach3{.name = "mach3",
                        .family = mach3_family,
                        .motion_ends_with_g80 = false,
                        .tool_change_moves_axes = true,
                        .g61_is_exact_stop = true,
                        .h_and_d_stand_alone = true,
                        .reference_beside_motion = true,
                        .parentheses_nest = true,
                        .comments_may_stay_open = true};

constexpr Dialect siemens{.name = "siemens",
                          .family = siemens_family,
                          .line_limit = 512,
                          .motion_ends_with_g80 = false,
                          .tool_change_moves_axes = true,
                          .h_and_d_stand_alone = true,
                          .dwell_takes_axis_words = true,
                          .reference_beside_motion = true,
                          .sinumerik_words = true,
                          .radius_name = "CR="};

/// Spelt otherwise than G-code, and read on its own.
constexpr Dialect heidenhain{.name = klartext_name, .tool_change_moves_axes = true};

constexpr std::array dialects{&linuxcnc, &grbl, &fanuc, &haas, &mach3, &siemens, &heidenhain};

bool is_blank_or_return(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

/// `line` without leading blanks and comments.
std::string_view first_words(std::string_view line) {
  while (!line.empty()) {
    if (is_blank_or_return(line.front())) {
      line.remove_prefix(1);
    } else if (line.front() == comment_open) {
      const std::size_t close = line.find(comment_close);
      line = close == std::string_view::npos ? std::string_view() : line.substr(close + 1);
    } else {
      break;
    }
  }
  return line;
}

/// "O1001" and nothing but blanks and comments; LinuxCNC's "O100 sub" is no number of a program.
bool is_program_number(std::string_view line) {
  line = first_words(line);
  if (line.empty() || (line.front() != 'O' && line.front() != 'o')) return false;
  std::size_t end = 1;
  while (end < line.size() && line[end] >= '0' && line[end] <= '9') ++end;
  if (end == 1) return false;
  const std::string_view rest = first_words(line.substr(end));
  return rest.empty() || rest.front() == ';';
}

bool says_nothing(std::string_view line) {
  line = first_words(line);
  return line.empty() || line.front() == ';' || line.front() == '%';
}

}  // namespace

const Dialect* find_dialect(std::string_view name) {
  for (const Dialect* dialect : dialects)
    if (dialect->name == name) return dialect;
  return nullptr;
}

std::string dialect_names() {
  std::string names = "auto";
  for (const Dialect* dialect : dialects) names.append(", ").append(dialect->name);
  return names;
}

const Dialect& detect_dialect(std::string_view text) {
  if (is_klartext(text)) return heidenhain;
  const std::string_view all = text;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    if (!says_nothing(line)) return is_program_number(line) ? fanuc : is_siemens(all) ? siemens : linuxcnc;
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  return linuxcnc;
}

}  // namespace counterflex
