#include "program/dialect.hpp"

#include <array>

#include "program/klartext_lex.hpp"
#include "program/known_codes.hpp"
#include "program/scanner.hpp"
#include "program/siemens_signs.hpp"

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
                       .comments_may_stay_open = true,
                       .radius_room = {0.005, 0.5},
                       .radius_room_inch = {0.005, 0.5}};

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
          .parentheses_nest = true,
          .comments_may_stay_open = true,
          .percent_names = true};
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
                          .radius_name = "CR=",
                          .radius_room = {0.01},
                          .radius_room_inch = {0.01}};

/// Spelt otherwise than G-code, and read on its own.
// Of the iTNC 530: "input tolerance up to 0.016 mm" of the start and end of an arc.
constexpr Dialect heidenhain{.name = klartext_name,
                             .tool_change_moves_axes = true,
                             .radius_room = {0.016},
                             .radius_room_inch = {0.016}};

constexpr std::array dialects{&linuxcnc, &grbl, &fanuc, &haas, &mach3, &siemens, &heidenhain};

/// Behind the comment that begins `line`, in which brackets may stand in pairs; nothing where it stays open.
std::string_view behind_comment(std::string_view line) {
  int depth = 0;
  for (std::size_t at = 0; at < line.size(); ++at) {
    if (line[at] == comment_open) ++depth;
    if (line[at] == comment_close && --depth == 0) return line.substr(at + 1);
  }
  const std::size_t close = line.find(comment_close);
  return close == std::string_view::npos ? std::string_view() : line.substr(close + 1);
}

/// `line` without leading blanks and comments.
std::string_view first_words(std::string_view line) {
  while (!line.empty()) {
    if (is_blank(line.front()) || says_nothing(line.front())) {
      line.remove_prefix(1);
    } else if (line.front() == comment_open) {
      line = behind_comment(line);
    } else {
      break;
    }
  }
  return line;
}

std::string_view without_digits(std::string_view text) {
  while (!text.empty() && is_digit(text.front())) text.remove_prefix(1);
  return text;
}

/// "O1001" or ":1001", with N before it or words and comments behind it; LinuxCNC's "O100 sub" is no number
/// of a program.
bool is_program_number(std::string_view line) {
  line = first_words(line);
  if (!line.empty() && upper(line.front()) == 'N') line = first_words(without_digits(line.substr(1)));
  if (line.empty() || (upper(line.front()) != 'O' && line.front() != ':')) return false;
  const std::string_view behind = without_digits(line.substr(1));
  if (behind.size() == line.size() - 1) return false;
  const std::string_view rest = first_words(behind);
  return rest.size() < 2 || !is_letter(rest[0]) || !is_letter(rest[1]);
}

/// What stands behind the '%' of a line may be the program's number.
std::string_view without_percent(std::string_view line) {
  line = first_words(line);
  return line.empty() || line.front() != '%' ? line : line.substr(1);
}

/// "%123", "%PART".
bool is_percent_name(std::string_view line) {
  line = first_words(line);
  return line.size() > 1 && line.front() == '%' && (is_letter(line[1]) || is_digit(line[1]));
}

/// "<PART-1>" or "O<PART-1>", the name of a program; LinuxCNC's "o<name> sub" is none.
bool is_part_name(std::string_view line) {
  line = first_words(line);
  if (!line.empty() && upper(line.front()) == 'O') line.remove_prefix(1);
  if (line.empty() || line.front() != '<' || line.find('>') == std::string_view::npos) return false;
  const std::string_view rest = first_words(line.substr(line.find('>') + 1));
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

namespace {

const Dialect& detect_shop_control(std::string_view text) {
  if (has_semicolon_comments(text) && knows_codes(text, mach3)) return mach3;
  return !knows_codes(text, fanuc) && knows_codes(text, haas) ? haas : fanuc;
}

/// Of programs without a number: what LinuxCNC refuses may be plain to others.
const Dialect& detect_hobby_control(std::string_view text) {
  if (names_grbl(text) && knows_codes(text, grbl)) return grbl;
  const bool others = !knows_codes(text, linuxcnc) || has_loose_comments(text);
  return others && knows_codes(text, mach3) ? mach3 : linuxcnc;
}

}  // namespace

const Dialect& detect_dialect(std::string_view text) {
  text.remove_prefix(byte_order_mark(text));
  if (is_klartext(text)) return heidenhain;
  if (text.starts_with("%MPF") || text.starts_with("%SPF")) return siemens;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    if (is_program_number(without_percent(line)) || is_part_name(line) || is_percent_name(line))
      return detect_shop_control(text);
    if (!says_nothing(line)) break;
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  if (is_siemens(text)) return siemens;
  return has_colon_numbers(text) ? detect_shop_control(text) : detect_hobby_control(text);
}

}  // namespace counterflex
