#include "program/siemens/lex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "program/siemens/names.hpp"
#include "program/siemens/signs.hpp"
#include "program/siemens/values.hpp"

namespace counterflex {
namespace {

bool has_digit_behind_letter(std::string_view name) {
  return name.size() > 1 && std::all_of(name.begin() + 1, name.end(), is_digit);
}

void lex_letter(Scanner& s);

bool equals_follows(const Scanner& s, std::size_t behind);

void state_machine_position(Scanner& s, std::string_view name) {
  Word& word = s.block.words.emplace_back();
  word.letter = 'G';
  word.value = 153;
  word.span = word.number = {s.at, s.at + name.size()};
  s.at = word.span.end;
}

/// The words of TRANS, ROT, ATRANS and AROT: X, Y, Z, and RPL as R.
void lex_frame(Scanner& s) {
  s.at += siemens_name_at(s).size();
  for (s.skip_blanks(); s.at < s.end && s.peek() != ';'; s.skip_blanks()) {
    const std::string_view name = is_letter(s.peek()) ? siemens_name_at(s) : std::string_view();
    const char letter = name.empty() ? '\0' : upper(name[0]);
    if (is_word(name, "RPL")) {
      read_named_word(s, 'R', name.size());
    } else if (letter >= 'X' && letter <= 'Z' && (name.size() == 1 || is_digit(name[1]))) {
      lex_letter(s);
    } else {
      const bool added =
          s.block.statement == Statement::added_shift || s.block.statement == Statement::added_turn;
      s.block.statement = added ? Statement::added_frame : Statement::frame;
      return skip_siemens_rest(s);
    }
  }
}

/// Whether only words with plain numbers that neither move nor call follow: "G40 G64 M8".
bool only_plain_words_follow(Scanner s) {
  for (s.skip_blanks(); s.at < s.end && s.peek() != ';'; s.skip_blanks()) {
    if (std::string_view("DFGHMST").find(upper(s.peek())) == std::string_view::npos) return false;
    const std::size_t number = ++s.at;
    while (s.at < s.end && (is_digit(s.peek()) || s.peek() == '.')) ++s.at;
    if (s.at == number || equals_follows(s, 0)) return false;
  }
  return true;
}

/// The list in brackets, if there is one. Words behind it that may move are not read.
void skip_list(Scanner& s) {
  if (s.peek() == '(') skip_siemens_value(s);
  if (only_plain_words_follow(s)) return;
  s.block.statement = Statement::not_read;
  skip_siemens_rest(s);
}

void state(Scanner& s, Statement statement) {
  s.block.statement = statement;
  const std::size_t begin = s.at;
  s.at += siemens_name_at(s).size();
  s.skip_blanks();
  const bool no_arguments = s.text.substr(s.at, s.end - s.at).starts_with("()");
  s.block.statement_is_bare = no_arguments || s.at == s.end || s.peek() == ';';
  const bool has_list = s.peek() == '(';
  if (statement == Statement::curve || (statement == Statement::smoothed && !has_list)) return;
  if (statement == Statement::smoothed || statement == Statement::transform_off) {
    skip_list(s);
    s.block.statement_text = {begin, s.at};
    return;
  }
  s.at = begin;
  if (statement >= Statement::shift && statement <= Statement::added_turn)
    lex_frame(s);
  else
    skip_siemens_rest(s);
  s.block.statement_text = {begin, s.at};
}

/// "REAL", "STRING[20]": the name of the type.
Span lex_type(Scanner& s) {
  const Span type{s.at, s.at + siemens_name_at(s).size()};
  s.at = type.end;
  s.skip_blanks();
  if (s.peek() == '[') skip_siemens_index(s);
  return type;
}

/// "PROC POCKET(REAL WIDTH, VAR INT COUNT=3)": the parameters, whose values are not known.
void lex_parameters(Scanner& s) {
  while (s.at < s.end && s.peek() != '(' && s.peek() != ';') ++s.at;
  const std::size_t end = std::min(s.text.find(')', s.at), s.end);
  while (s.at < end && s.peek() != ';') {
    const std::size_t begin = ++s.at;
    s.skip_blanks();
    Span type = lex_type(s);
    if (is_word(part(s.text, type), "VAR")) type = lex_type(s);
    s.skip_blanks();
    const Span name{s.at, s.at + siemens_name_at(s).size()};
    while (s.at < end && s.peek() != ',') ++s.at;
    if (!empty(name)) s.block.assignments.push_back({name, {begin, s.at}, type});
  }
  skip_siemens_rest(s);
}

bool lex_structure(Scanner& s, std::string_view name) {
  if (!is_siemens_structure(name)) return false;
  Span keyword{s.at, s.at + name.size()};
  s.at = keyword.end;
  if (is_word(name, "PROC")) {
    lex_parameters(s);
    return true;
  }
  s.skip_blanks();
  const bool alone = s.at == s.end || s.peek() == ';';
  const std::size_t rest = s.at;
  skip_siemens_rest(s);
  const bool jump = siemens_jumps(s.text.substr(rest, s.at - rest));
  // A part that is repeated by labels makes the whole program a body, as jumps do.
  const bool repeats_part = is_word(name, "REPEATB") || (is_word(name, "REPEAT") && !alone);
  if (!jump && !repeats_part) s.block.flow_keyword = keyword;
  return true;
}

/// "DEF REAL DEPTH=-2.5, WIDTH": each variable is set; without a value it is zero.
void lex_declaration(Scanner& s) {
  s.at += siemens_name_at(s).size();
  s.skip_blanks();
  const Span type = lex_type(s);
  for (s.skip_blanks(); s.at < s.end && s.peek() != ';'; s.skip_blanks()) {
    const std::size_t begin = s.at;
    s.at += siemens_name_at(s).size();
    if (s.peek() == '[') skip_siemens_index(s);
    const Span variable{begin, s.at};
    s.skip_blanks();
    Span value{s.at, s.at};
    if (s.peek() == '=') {
      value.begin = ++s.at;
      int depth = 0;
      for (; s.at < s.end && s.peek() != ';' && (depth > 0 || s.peek() != ','); ++s.at) {
        depth += s.peek() == '(' || s.peek() == '[';
        depth -= s.peek() == ')' || s.peek() == ']';
      }
      value.end = s.at;
    }
    s.block.assignments.push_back({variable, value, type});
    if (s.peek() != ',') return skip_siemens_rest(s);
    ++s.at;
  }
}

/// A name with its value or arguments: "SPOS=0", "ACC[X]=80", "MSG(\"TEXT\")", "FFWON".
void skip_harmless(Scanner& s, std::string_view name) {
  if (is_word(name, "DEF")) return lex_declaration(s);
  if (is_word(name, "DEFINE") || is_word(name, "EXTERN") || is_word(name, "PROC") ||
      is_word(name.substr(0, 4), "GOTO") || is_word(name, "CASE"))
    return skip_siemens_rest(s);
  if (is_speed_name(name)) return take_speed_word(s, name.size());
  s.at += name.size();
  s.skip_blanks();
  if (s.peek() == '(') skip_siemens_value(s), s.skip_blanks();
  if (s.peek() == '[') skip_siemens_index(s), s.skip_blanks();
  if (s.peek() != '=') return;
  ++s.at;
  s.skip_blanks();
  skip_siemens_value(s);
}

/// G74 and G75 move to machine positions, whose axes have other names: "G74 X1=0 Z1=0".
bool moves_to_machine_position(const Block& block) {
  return std::any_of(block.words.begin(), block.words.end(), [](const Word& word) {
    return word.letter == 'G' && (word.value == 74 || word.value == 75);
  });
}

/// Letters of words with a number of their own before '=': "R1=", "M3=", "S2=", and axes "X1=", "A3=". M and
/// S have the number of a spindle.
void skip_numbered_assignment(Scanner& s, std::string_view name) {
  const char letter = upper(name[0]);
  if (letter != 'R' && may_move(letter) && s.block.statement != Statement::curve &&
      !moves_to_machine_position(s.block))
    return state(s, Statement::call);
  s.block.assigns = true;
  if (letter == 'M' || letter == 'S') return take_speed_word(s, name.size());
  const std::size_t begin = s.at;
  s.at += name.size();
  while (s.peek() != '=') ++s.at;
  take_assigned(s, {begin, begin + name.size()});
}

/// "R[5]=1": an R parameter by its index. False for other text.
bool lex_indexed_parameter(Scanner& s, std::string_view name) {
  if (!is_word(name, "R") || s.text.substr(s.at + 1, 1) != "[") return false;
  Scanner ahead = s;
  ++ahead.at;
  skip_siemens_index(ahead);
  const Span variable{s.at, ahead.at};
  ahead.skip_blanks();
  if (ahead.peek() != '=') return false;
  s.at = ahead.at;
  s.block.assigns = true;
  take_assigned(s, variable);
  return true;
}

/// "_DEPTH=5", "MEAS=1", "$AC_TIMER[1]=0": a variable or a word of the control. Other effects of the block
/// are unknown. "DIAMONA[X]" without '=' is a word of the control.
void skip_named_assignment(Scanner& s, std::string_view name) {
  const std::size_t begin = s.at;
  s.at += name.size();
  s.skip_blanks();
  if (s.peek() == '[') skip_siemens_index(s);
  const Span variable{begin, s.at};
  s.skip_blanks();
  if (s.peek() != '=') {
    s.at = begin;
    return state(s, Statement::call);
  }
  s.block.assigns = s.block.assigns_by_name = true;
  take_assigned(s, variable);
}

bool equals_follows(const Scanner& s, std::size_t behind) {
  Scanner ahead = s;
  ahead.at += behind;
  ahead.skip_blanks();
  return ahead.peek() == '=' && (ahead.at + 1 >= s.end || s.text[ahead.at + 1] != '=');
}

void lex_letter(Scanner& s) {
  const char letter = upper(s.peek());
  if (!equals_follows(s, 1)) {
    const std::size_t begin = s.at;
    lex_word(s);
    if (letter == 'R')
      s.refuse_at(begin,
                  fmt::format("{0} is an R parameter without a value: the radius of an arc is CR=, and "
                              "the parameter is set by {0}=",
                              s.text.substr(begin, s.at - begin)));
    return;
  }
  const std::size_t words = s.block.words.size();
  read_named_word(s, letter, 1);
  Word& word = s.block.words[words];
  if (letter == 'P') word.value -= 1;
  // An M with an expression does not affect moves.
  if (!word.literal && (letter == 'M' || letter == 'H')) s.block.words.pop_back();
}

/// "RND=4", "CHR=2", "CHF=3": the corner with the next move. False for other names.
bool lex_corner(Scanner& s, std::string_view name) {
  struct Corner {
    std::string_view name;
    CornerKind kind;
  };
  constexpr std::array corners{Corner{"RND", CornerKind::round}, Corner{"CHR", CornerKind::side},
                               Corner{"CHF", CornerKind::chamfer}};
  const auto found =
      std::find_if(corners.begin(), corners.end(), [&](const Corner& c) { return is_word(name, c.name); });
  if (found == corners.end() || !equals_follows(s, name.size())) return false;
  read_named_word(s, 'R', name.size());
  const Word word = s.block.words.back();
  s.block.words.pop_back();
  s.block.corner = CornerSize{word.literal ? word.value : NAN, found->kind};
  return true;
}

/// "ANG=30": the direction of a line in the plane, measured from its first axis.
void lex_angle(Scanner& s) {
  read_named_word(s, 'R', 3);
  s.block.angle = s.block.words.back();
  s.block.words.pop_back();
}

bool lex_label(Scanner& s, std::string_view name) {
  const std::size_t behind = s.at + name.size();
  if (behind >= s.end || s.text[behind] != ':' || (behind + 1 < s.end && s.text[behind + 1] == '='))
    return false;
  s.at = behind + 1;
  return true;
}

void lex_name(Scanner& s, std::string_view name) {
  if (is_word(name, "CR") && equals_follows(s, 2)) return read_named_word(s, 'R', 2);
  if (is_word(name, "TURN") && equals_follows(s, 4)) return read_named_word(s, 'P', 4);
  if (is_word(name, "ANG") && equals_follows(s, 3)) return lex_angle(s);
  if (lex_corner(s, name)) return;
  if (is_word(name, "SUPA")) return state_machine_position(s, name);
  if (lex_structure(s, name)) return;
  if (const auto statement = statement_of_name(name)) return state(s, *statement);
  if (is_harmless_name(name)) return skip_harmless(s, name);
  if (is_cycle_name(name)) return state(s, Statement::cycle);
  if (name.starts_with('$') && !is_harmless_variable(name)) s.block.statement = Statement::data;
  if (name.starts_with('$') || equals_follows(s, name.size()) || s.text.substr(s.at + name.size(), 1) == "[")
    return is_position_name(name) ? state(s, Statement::call) : skip_named_assignment(s, name);
  state(s, Statement::call);
}

bool is_modal_of_several_letters(std::string_view name) {
  return name.size() > 1 && !has_digit_behind_letter(name) && is_letter(name[1]);
}

/// Letters in a row that are a word and the begin of the next one: "G1X5Y2" is not a name.
bool is_run_of_words(std::string_view name) {
  return name.size() > 1 && is_digit(name[1]) && std::any_of(name.begin() + 1, name.end(), is_letter);
}

void lex_siemens_word(Scanner& s) {
  const std::string_view name = siemens_name_at(s);
  const bool single =
      is_letter(name[0]) && (name.size() == 1 || is_run_of_words(name) || has_digit_behind_letter(name));
  if (lex_label(s, name) || lex_indexed_parameter(s, name)) return;
  if (!single || is_modal_of_several_letters(name)) return lex_name(s, name);
  const char letter = upper(name[0]);
  if (has_digit_behind_letter(name) && equals_follows(s, name.size()))
    return skip_numbered_assignment(s, name);
  if (letter == 'L' && has_digit_behind_letter(name)) return state(s, Statement::call);
  lex_letter(s);
}

void lex_siemens_comment(Scanner& s) {
  s.block.comments.push_back({s.at + 1, s.end});
  s.at = s.end;
}

void lex_siemens_skip(Scanner& s) {
  const std::size_t begin = s.at++;
  if (is_digit(s.peek())) ++s.at;
  s.block.block_delete = {begin, s.at};
}

}  // namespace

void lex_siemens(Scanner& s) {
  s.skip_blanks();
  if (s.peek() == '%') {
    s.block.percent = true;
    return;
  }
  for (; s.at < s.end; s.skip_blanks()) {
    const char c = s.peek();
    if (is_letter(c) || c == '$' || c == '_') {
      lex_siemens_word(s);
    } else if (c == ';') {
      lex_siemens_comment(s);
    } else if (c == '/' && empty(s.block.block_delete)) {
      lex_siemens_skip(s);
    } else if (c == ':' && s.at + 1 < s.end && is_digit(s.text[s.at + 1])) {
      ++s.at;
      while (is_digit(s.peek())) ++s.at;
    } else {
      refuse_character(s);
    }
  }
  const auto moves = [](const Word& word) { return may_move(word.letter); };
  if (s.block.assigns_by_name && std::any_of(s.block.words.begin(), s.block.words.end(), moves))
    s.block.statement = Statement::not_read;
}

}  // namespace counterflex
