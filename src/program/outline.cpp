#include "program/outline.hpp"

#include <algorithm>

#include "program/robot/apt/lex.hpp"
#include "program/robot/kuka/names.hpp"
#include "program/siemens/signs.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// Whether `at` is in a comment of its line.
bool in_comment(std::string_view text, std::size_t at) {
  for (std::size_t i = at; i-- > 0 && text[i] != '\n';) {
    if (text[i] == comment_close) return false;
    if (text[i] == comment_open) return true;
  }
  return false;
}

enum class Ending { none, of_program, of_subprogram };

/// What the M at `at` ends.
Ending ending_at(std::string_view text, std::size_t at) {
  std::size_t i = at + 1;
  while (i < text.size() && is_blank(text[i])) ++i;
  int code = 0, digits = 0;
  for (; i < text.size() && is_digit(text[i]) && digits < 6; ++i, ++digits)
    code = code * 10 + (text[i] - '0');
  if (digits == 0 || in_comment(text, at)) return Ending::none;
  if (code == 99) return Ending::of_subprogram;
  return code == 2 || code == 30 ? Ending::of_program : Ending::none;
}

Ending first_ending(std::string_view text, std::size_t from) {
  for (std::size_t at = from; (at = find_either(text, 'M', 'm', at)) != std::string_view::npos; ++at)
    if (const Ending ending = ending_at(text, at); ending != Ending::none) return ending;
  return Ending::none;
}

bool goto_at(std::string_view text, std::size_t o) {
  return o > 0 && is_word(text.substr(o - 1, 4), "GOTO") && !in_comment(text, o);
}

bool begins_line(std::string_view text, std::size_t at) {
  for (std::size_t i = at; i-- > 0 && text[i] != '\n';)
    if (!is_blank(text[i])) return false;
  return true;
}

bool is_number_at(std::string_view text, std::size_t o) {
  return o + 1 < text.size() && is_digit(text[o + 1]) && begins_line(text, o);
}

/// Lines that begin with an O-number or ":1000", in order.
std::vector<std::size_t> numbers_in(std::string_view lines) {
  std::vector<std::size_t> numbers;
  for (std::size_t at = 0; (at = find_either(lines, 'O', 'o', at)) != std::string_view::npos; ++at)
    if (is_number_at(lines, at)) numbers.push_back(at);
  const auto others = static_cast<std::ptrdiff_t>(numbers.size());
  for (std::size_t at = 0; (at = lines.find(':', at)) != std::string_view::npos; ++at)
    if (is_number_at(lines, at)) numbers.push_back(at);
  std::inplace_merge(numbers.begin(), numbers.begin() + others, numbers.end());
  return numbers;
}

/// Whether the M at `at` jumps to a block number: M99 P10, and M96 P10 of Haas.
bool m_jumps_at(std::string_view text, std::size_t at, bool has_m96) {
  const std::size_t digits = text.find_first_not_of(" \t", at + 1);
  if (digits == std::string_view::npos || in_comment(text, at)) return false;
  const std::string_view number = text.substr(digits, 3);
  const bool ends = number.size() < 3 || !is_digit(number[2]);
  if (!ends || !(number.starts_with("99") || (has_m96 && number.starts_with("96")))) return false;
  const std::string_view rest = text.substr(digits, text.find_first_of("\n(", digits) - digits);
  return find_either(rest, 'P', 'p', 0) != std::string_view::npos;
}

bool m_jumps_in(std::string_view lines, bool has_m96) {
  for (std::size_t at = 0; (at = find_either(lines, 'M', 'm', at)) != std::string_view::npos; ++at)
    if (m_jumps_at(lines, at, has_m96)) return true;
  return false;
}

bool jumps_in(std::string_view lines) {
  for (const char o : {'O', 'o'})
    for (std::size_t at = 0; (at = lines.find(o, at)) != std::string_view::npos; ++at)
      if (goto_at(lines, at)) return true;
  return false;
}

/// "POCKET" of "PROC POCKET(REAL A) SAVE" and "%_N_POCKET_SPF"; empty for other lines.
std::string_view sinumerik_program_in(std::string_view line) {
  constexpr std::string_view proc = "PROC", sign = "%_N_";
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  const bool is_proc = is_word(line.substr(0, proc.size()), proc);
  if (!is_proc && !is_word(line.substr(0, sign.size()), sign)) return {};
  line.remove_prefix(is_proc ? std::min(line.find_first_not_of(" \t", proc.size()), line.size())
                             : sign.size());
  const auto end = std::ranges::find_if_not(line, is_identifier_character);
  const std::string_view name = line.substr(0, static_cast<std::size_t>(end - line.begin()));
  const std::string_view ending = name.substr(name.size() - std::min<std::size_t>(name.size(), 4));
  const bool has_ending = !is_proc && (is_word(ending, "_SPF") || is_word(ending, "_MPF"));
  return name.substr(0, name.size() - (has_ending ? ending.size() : 0));
}

/// The name of the program that a line of G-code defines, in upper case: "O100" of "O0100" and "o100 sub",
/// "POCKET" of "o<pocket> sub". Empty for other lines.
std::string program_defined_in(std::string_view line, const Dialect& dialect) {
  if (dialect.sinumerik_words) return upper_case(sinumerik_program_in(line));
  std::string code = upper_case(line.substr(0, line.find_first_of("(;")));
  std::erase_if(code, [](char c) { return is_blank(c) || c == '\r'; });
  if (dialect.percent_names && code.starts_with(':')) code[0] = 'O';
  if (!code.starts_with('O') || (dialect.o_words && !code.ends_with("SUB"))) return {};
  if (code.starts_with("O<")) return code.substr(2, code.find('>') - 2);
  const std::size_t begin = std::min(code.find_first_not_of('0', 1), code.size());
  return "O" + code.substr(begin, code.find_first_not_of("0123456789", begin) - begin);
}

}  // namespace

/// Whether harmless names may be those of programs that the text defines.
bool OutlineScan::names_programs() const {
  return !harmless_.empty() && dialect_.language.empty() && dialect_.name != klartext_name;
}

void OutlineScan::add_own_programs(std::string_view lines) {
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size() - 1) + 1;
    std::string name = program_defined_in(lines.substr(0, end - 1), dialect_);
    if (harmless_.contains(name)) outline_.own_programs.insert(std::move(name));
    lines.remove_prefix(end);
  }
}

bool OutlineScan::may_find() const {
  return names_programs() || dialect_.sinumerik_words || dialect_.name == klartext_name ||
         !dialect_.language.empty() || (dialect_.family & (shop_families | mach3_family)) != 0;
}

void OutlineScan::add(std::string_view blocks) {
  if (names_programs()) add_own_programs(blocks);
  if (dialect_.name == klartext_name)
    klartext_.add(blocks);
  else if (dialect_.name == kuka_name)
    add_krl(blocks);
  else if (dialect_.name == abb_name)
    rapid_.add(blocks);
  else if (dialect_.name == ur_name || dialect_.name == tp_name || dialect_.name == yaskawa_name)
    outline_.named_targets = true;  // blend radii of UR depend on the moves beside them, too
  else if (dialect_.name == apt_name)
    outline_.tool_axes = outline_.tool_axes || gives_tool_axes(blocks);
  else
    add_numbered(blocks);
}

void OutlineScan::add_krl(std::string_view lines) {
  if (outline_.list_follows_loop) return;
  outline_.named_targets = outline_.named_targets || names_targets(lines);
  if (!outline_.data_lists) {
    const std::size_t list = data_list_at(lines);
    krl_.add(lines.substr(0, list));
    outline_.data_lists = list < lines.size();
    const std::string_view mark = lines.substr(list, lines.find('\n', list) - list);
    outline_.list_follows_loop = number_behind_mark(mark).has_value();
    if (outline_.list_follows_loop) outline_.named_targets = false;
    if (outline_.list_follows_loop) return;
    lines.remove_prefix(list);
  }
  if (!lines.empty()) add_elements(lines, outline_.arrays);
  outline_.named_targets = outline_.named_targets || !outline_.arrays.empty();
}

void OutlineScan::add_numbered(std::string_view lines) {
  if (!begun_) lines.remove_prefix(byte_order_mark(lines));
  begun_ = true;
  if (dialect_.sinumerik_words) outline_.jumps = outline_.jumps || siemens_jumps(lines);
  if ((dialect_.family & (shop_families | mach3_family)) == 0) return;
  const bool shop = (dialect_.family & shop_families) != 0;
  outline_.jumps =
      outline_.jumps || jumps_in(lines) || (shop && m_jumps_in(lines, (dialect_.family & haas_family) != 0));
  std::vector<bool>& list = outline_.subprograms;
  std::size_t from = 0;
  const auto close_until = [&](std::size_t end) {
    if (open_ == 0) return;
    const Ending ending = first_ending(lines.substr(0, end), from);
    if (ending == Ending::none) return;
    std::fill(list.end() - static_cast<std::ptrdiff_t>(open_), list.end(), ending == Ending::of_subprogram);
    open_ = 0;
  };
  for (const std::size_t number : numbers_in(lines)) {
    close_until(number);
    from = number;
    list.push_back(false);
    ++open_;
  }
  close_until(lines.size());
}

Outline OutlineScan::finish() {
  // A single program that ends with M99 repeats itself. It is not a subprogram.
  if (outline_.subprograms.size() < 2) outline_.subprograms.assign(outline_.subprograms.size(), false);
  outline_.klartext = klartext_.finish();
  outline_.krl = krl_.finish();
  outline_.named_targets = outline_.named_targets || rapid_.depends_on_far_lines();
  outline_.routines = rapid_.routines();
  outline_.still_routines = rapid_.still_routines();
  return std::move(outline_);
}

bool is_numbered(std::string_view line) {
  const std::size_t o = line.find_first_of("Oo:");
  return o != std::string_view::npos && is_number_at(line, o);
}

Outline outline_of(std::string_view text, const Dialect& dialect, const CallNames& harmless) {
  OutlineScan scan(dialect, harmless);
  scan.add(text);
  return scan.finish();
}

}  // namespace counterflex
