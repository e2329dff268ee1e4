#include "program/detect/detect_dialect.hpp"

#include "program/detect/known_codes.hpp"
#include "program/klartext/lex.hpp"
#include "program/siemens/signs.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

const Dialect& named(std::string_view name) {
  return *find_dialect(name);
}

/// Position behind the comment that begins `line`, which may contain pairs of brackets. Empty if the comment
/// is not closed.
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
    if (is_blank(line.front()) || is_ignored(line.front())) {
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

/// "O1001" or ":1001", with N before it or words and comments behind it. LinuxCNC's "O100 sub" is not a
/// program number.
bool is_program_number(std::string_view line) {
  line = first_words(line);
  if (!line.empty() && upper(line.front()) == 'N') line = first_words(without_digits(line.substr(1)));
  if (line.empty() || (upper(line.front()) != 'O' && line.front() != ':')) return false;
  const std::string_view behind = without_digits(line.substr(1));
  if (behind.size() == line.size() - 1) return false;
  const std::string_view rest = first_words(behind);
  return rest.size() < 2 || !is_letter(rest[0]) || !is_letter(rest[1]);
}

/// Text behind the '%' of a line, which may be the number of the program.
std::string_view without_percent(std::string_view line) {
  line = first_words(line);
  return line.empty() || line.front() != '%' ? line : line.substr(1);
}

/// "%123", "%PART".
bool is_percent_name(std::string_view line) {
  line = first_words(line);
  return line.size() > 1 && line.front() == '%' && (is_letter(line[1]) || is_digit(line[1]));
}

/// "<PART-1>" or "O<PART-1>", the name of a program; LinuxCNC's "o<name> sub" is not a name.
bool is_part_name(std::string_view line) {
  line = first_words(line);
  if (!line.empty() && upper(line.front()) == 'O') line.remove_prefix(1);
  if (line.empty() || line.front() != '<' || line.find('>') == std::string_view::npos) return false;
  const std::string_view rest = first_words(line.substr(line.find('>') + 1));
  return rest.empty() || rest.front() == ';';
}

bool is_ignored(std::string_view line) {
  line = first_words(line);
  return line.empty() || line.front() == ';' || line.front() == '%';
}

const Dialect& detect_shop_control(std::string_view text) {
  if (has_semicolon_comments(text) && knows_codes(text, named("mach3"))) return named("mach3");
  const bool needs_haas = !knows_codes(text, named("fanuc")) && knows_codes(text, named("haas"));
  return named(needs_haas ? "haas" : "fanuc");
}

/// For programs without a number. Text that LinuxCNC refuses may be valid for other controls.
const Dialect& detect_hobby_control(std::string_view text) {
  if (names_grbl(text) && knows_codes(text, named("grbl"))) return named("grbl");
  const bool others = !knows_codes(text, named("linuxcnc")) || has_loose_comments(text);
  return named(others && knows_codes(text, named("mach3")) ? "mach3" : "linuxcnc");
}

}  // namespace

const Dialect& detect_dialect(std::string_view text) {
  text.remove_prefix(byte_order_mark(text));
  if (is_klartext(text)) return named(klartext_name);
  if (text.starts_with("%MPF") || text.starts_with("%SPF")) return named("siemens");
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    if (is_program_number(without_percent(line)) || is_part_name(line) || is_percent_name(line))
      return detect_shop_control(text);
    if (!is_ignored(line)) break;
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  if (is_siemens(text)) return named("siemens");
  return has_colon_numbers(text) ? detect_shop_control(text) : detect_hobby_control(text);
}

}  // namespace counterflex
