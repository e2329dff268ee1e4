#include "program/siemens/lex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "counterflex/files/text.hpp"

namespace counterflex {
namespace {

/// Effect of a name at the beginning of a statement on later moves.
struct SiemensName {
  std::string_view name;
  Statement statement;
};

// Names that are not listed are subprograms or cycles.
constexpr std::array siemens_names{
    SiemensName{"TRANS", Statement::shift},
    SiemensName{"ROT", Statement::turn},
    SiemensName{"ROTS", Statement::frame},
    SiemensName{"SCALE", Statement::frame},
    SiemensName{"MIRROR", Statement::frame},
    SiemensName{"ATRANS", Statement::added_shift},
    SiemensName{"AROT", Statement::added_turn},
    SiemensName{"AROTS", Statement::added_frame},
    SiemensName{"ASCALE", Statement::added_frame},
    SiemensName{"AMIRROR", Statement::added_frame},
    SiemensName{"CYCLE800", Statement::tilt},
    SiemensName{"TRAORI", Statement::transformed},
    SiemensName{"TRANSMIT", Statement::transformed},
    SiemensName{"TRACYL", Statement::transformed},
    SiemensName{"TRAANG", Statement::transformed},
    SiemensName{"TRAFOOF", Statement::transform_off},
    SiemensName{"MCALL", Statement::modal_call},
    SiemensName{"CYCLE832", Statement::smoothed},
    SiemensName{"COMPCAD", Statement::smoothed},
    SiemensName{"COMPCURV", Statement::smoothed},
    SiemensName{"COMPON", Statement::smoothed},
    SiemensName{"COMPSURF", Statement::smoothed},
    SiemensName{"ASPLINE", Statement::curve},
    SiemensName{"BSPLINE", Statement::curve},
    SiemensName{"CSPLINE", Statement::curve},
    SiemensName{"POLY", Statement::curve},
    SiemensName{"CIP", Statement::curve},
    SiemensName{"CT", Statement::curve},
    SiemensName{"INVCW", Statement::curve},
    SiemensName{"INVCCW", Statement::curve},
    SiemensName{"RET", Statement::end},
};

// Names that neither move an axis nor affect moves.
constexpr std::array harmless_names{
    "MSG",       "STOPRE",   "FFWON",     "FFWOF",       "SOFT",      "BRISK",   "DRIVE",    "CUT2D",
    "CUT2DF",    "COMPOF",   "NORM",      "KONT",        "KONTC",     "KONTT",   "FGROUP",   "FGREF",
    "FTOCON",    "FTOCOF",   "WORKPIECE", "SPOS",        "SPCON",     "SPCOF",   "SETMS",    "DISPLOF",
    "DISPLON",   "SAVE",     "SBLOF",     "SBLON",       "UPATH",     "SPATH",   "CFC",      "CFTCP",
    "CFIN",      "FIFOCTRL", "WALIMON",   "WALIMOF",     "DYNNORM",   "DYNPOS",  "DYNROUGH", "DYNSEMIFIN",
    "DYNFINISH", "DYNPREC",  "ORISOF",    "ORISON",      "ORIWKS",    "ORIMKS",  "ORIAXES",  "ORIVECT",
    "CTOL",      "OTOL",     "ATOL",      "OVR",         "OVRA",      "OVRRAP",  "FL",       "FA",
    "FRC",       "FRCM",     "FB",        "FZ",          "SCC",       "SVC",     "ADIS",     "ADISPOS",
    "DISC",      "ACC",      "LIMS",      "VELOLIM",     "JERKLIM",   "RTLION",  "RTLIOF",   "DEF",
    "DEFINE",    "EXTERN",   "PROC",      "GROUP_BEGIN", "GROUP_END", "GOTO",    "GOTOF",    "GOTOB",
    "GOTOC",     "GOTOS",    "CASE",      "SPINDLE",     "SYNFCT",    "STOPREC",
};

constexpr std::array<std::string_view, 13> structures{"IF",    "ELSE",    "ENDIF", "WHILE",   "ENDWHILE",
                                                      "FOR",   "ENDFOR",  "LOOP",  "ENDLOOP", "REPEAT",
                                                      "UNTIL", "REPEATB", "PROC"};

// Names that affect moves; other names before '=' are variables.
constexpr std::array position_names{"AP", "RP", "AR", "OFFN", "RNDM", "DISR", "DISCL", "POS", "POSA", "FP"};

bool is_name_character(char c) {
  return is_letter(c) || is_digit(c) || c == '_' || c == '$';
}

std::string_view name_at(const Scanner& s) {
  std::size_t end = s.at;
  while (end < s.end && is_name_character(s.text[end])) ++end;
  return s.text.substr(s.at, end - s.at);
}

bool has_digit_behind_letter(std::string_view name) {
  return name.size() > 1 && std::all_of(name.begin() + 1, name.end(), is_digit);
}

/// Skips to the comment.
void skip_siemens_rest(Scanner& s) {
  bool quoted = false;
  for (; s.at < s.end && (quoted || s.peek() != ';'); ++s.at)
    if (s.peek() == '"') quoted = !quoted;
}

/// A value, up to a blank outside of brackets and quotes.
void skip_value(Scanner& s) {
  int depth = 0;
  bool quoted = false;
  for (; s.at < s.end; ++s.at) {
    const char c = s.peek();
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == '(' || c == '[') ++depth;
    if (c == ')' || c == ']') --depth;
    if (depth <= 0 && (is_blank(c) || c == ';')) break;
  }
}

constexpr std::array<std::string_view, 9> operators{"DIV",   "MOD",  "AND",   "OR", "XOR",
                                                    "B_AND", "B_OR", "B_XOR", "NOT"};

/// Skips an operator; false if there is no operator at the scanner.
bool skip_operator(Scanner& s) {
  const std::size_t begin = s.at;
  while (s.at < s.end && std::string_view("+-*/<>=").find(s.peek()) != std::string_view::npos) ++s.at;
  if (s.at > begin) return true;
  const std::string_view name = name_at(s);
  const bool found =
      std::any_of(operators.begin(), operators.end(), [&](auto known) { return is_word(name, known); });
  if (found) s.at += name.size();
  return found;
}

/// An assigned expression: values with operators between them.
void skip_assigned(Scanner& s) {
  for (bool more = true; more; more = skip_operator(s)) {
    s.skip_blanks();
    skip_value(s);
    s.skip_blanks();
  }
}

/// "[X]", "[R1, 2]".
void skip_index(Scanner& s) {
  int depth = 0;
  do {
    if (s.peek() == '[') ++depth;
    if (s.peek() == ']') --depth;
    ++s.at;
  } while (depth > 0 && s.at < s.end);
}

/// Assigns the value behind the '=' at the scanner to `variable`.
void take_assigned(Scanner& s, Span variable) {
  const std::size_t value = ++s.at;
  skip_assigned(s);
  s.block.assignments.push_back({variable, {value, s.at}});
}

int decimals_in_plain(std::string_view number) {
  const std::size_t point = number.find('.');
  return point == std::string_view::npos ? 0 : static_cast<int>(number.size() - point - 1);
}

std::optional<double> plain_number(std::string_view text) {
  return text.find_first_not_of("+-.0123456789") == std::string_view::npos ? read_number(text) : std::nullopt;
}

/// "12.5", "AC(12.5)", "IC(-3)" behind the '=' of a word. Any other value is an expression.
void read_siemens_value(Scanner& s, Word& word) {
  s.skip_blanks();
  Span value{s.at, s.at};
  skip_value(s);
  word.span.end = value.end = s.at;
  if (empty(value)) s.refuse_at(s.at - 1, fmt::format("{}= has no value", word.letter));
  const std::string_view text = part(s.text, value);
  const bool absolute = is_word(text.substr(0, 3), "AC("), relative = is_word(text.substr(0, 3), "IC(");
  if ((absolute || relative) && text.back() == ')') {
    value = {value.begin + 3, value.end - 1};
    word.mode = absolute ? DistanceMode::absolute : DistanceMode::relative;
    s.block.has_own_mode = true;
  }
  word.number = value;
  const auto number = plain_number(part(s.text, value));
  word.literal = number.has_value();
  word.value = number.value_or(0);
  word.point = part(s.text, value).find('.') != std::string_view::npos;
  word.decimals = decimals_in_plain(part(s.text, value));
}

/// "CR=4." is the radius of an arc, "TURN=2" its additional full turns.
void read_named_word(Scanner& s, char letter, std::size_t name_length) {
  Word& word = s.block.words.emplace_back();
  word.letter = letter;
  word.span.begin = s.at;
  s.at += name_length;
  s.skip_blanks();
  ++s.at;
  read_siemens_value(s, word);
  if (letter == 'P') word.value += 1;
}

void lex_letter(Scanner& s);

void state_machine_position(Scanner& s, std::string_view name) {
  Word& word = s.block.words.emplace_back();
  word.letter = 'G';
  word.value = 153;
  word.span = word.number = {s.at, s.at + name.size()};
  s.at = word.span.end;
}

/// The words of TRANS, ROT, ATRANS and AROT: X, Y, Z, and RPL as R.
void lex_frame(Scanner& s) {
  s.at += name_at(s).size();
  for (s.skip_blanks(); s.at < s.end && s.peek() != ';'; s.skip_blanks()) {
    const std::string_view name = is_letter(s.peek()) ? name_at(s) : std::string_view();
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

void state(Scanner& s, Statement statement) {
  s.block.statement = statement;
  const std::size_t begin = s.at;
  s.at += name_at(s).size();
  s.skip_blanks();
  const bool no_arguments = s.text.substr(s.at, s.end - s.at).starts_with("()");
  s.block.statement_is_bare = no_arguments || s.at == s.end || s.peek() == ';';
  s.at = begin;
  if (statement == Statement::curve) {
    s.at += name_at(s).size();
    return;
  }
  if (statement >= Statement::shift && statement <= Statement::added_turn) return lex_frame(s);
  skip_siemens_rest(s);
  s.block.statement_text = {begin, s.at};
}

bool lex_structure(Scanner& s, std::string_view name) {
  const auto found = std::find_if(structures.begin(), structures.end(),
                                  [&](std::string_view known) { return is_word(name, known); });
  if (found == structures.end()) return false;
  Span keyword{s.at, s.at + name.size()};
  s.at = keyword.end;
  s.skip_blanks();
  const bool alone = s.at == s.end || s.peek() == ';';
  const std::size_t rest = s.at;
  skip_siemens_rest(s);
  const bool jump = s.text.substr(rest, s.at - rest).find("GOTO") != std::string_view::npos;
  // A part that is repeated by labels makes the whole program a body, as jumps do.
  const bool repeats_part = *found == "REPEATB" || (*found == "REPEAT" && !alone);
  if (!jump && !repeats_part && *found != "PROC") s.block.flow_keyword = keyword;
  return true;
}

/// "DEF REAL DEPTH=-2.5, WIDTH": each variable is set; without a value it is zero.
void lex_declaration(Scanner& s) {
  s.at += name_at(s).size();
  s.skip_blanks();
  s.at += name_at(s).size();
  for (s.skip_blanks(); s.at < s.end && s.peek() != ';'; s.skip_blanks()) {
    const std::size_t begin = s.at;
    s.at += name_at(s).size();
    if (s.peek() == '[') skip_index(s);
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
    s.block.assignments.push_back({variable, value});
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
  s.at += name.size();
  s.skip_blanks();
  if (s.peek() == '(' || s.peek() == '[') skip_value(s), s.skip_blanks();
  if (s.peek() != '=') return;
  ++s.at;
  s.skip_blanks();
  skip_value(s);
}

/// G74 and G75 move to machine positions, whose axes have other names: "G74 X1=0 Z1=0".
bool moves_to_machine_position(const Block& block) {
  return std::any_of(block.words.begin(), block.words.end(), [](const Word& word) {
    return word.letter == 'G' && (word.value == 74 || word.value == 75);
  });
}

/// Letters of words with a number of their own before '=': "R1=", "M3=", "S2=", and axes "X1=", "A3=".
void skip_numbered_assignment(Scanner& s, std::string_view name) {
  const char letter = upper(name[0]);
  if (letter != 'R' && may_move(letter) && !moves_to_machine_position(s.block))
    return state(s, Statement::call);
  s.block.assigns = true;
  const std::size_t begin = s.at;
  s.at += name.size();
  while (s.peek() != '=') ++s.at;
  take_assigned(s, {begin, begin + name.size()});
}

/// "_DEPTH=5", "MEAS=1", "$AC_TIMER[1]=0": a variable or a word of the control. Other effects of the block
/// are unknown.
void skip_named_assignment(Scanner& s, std::string_view name) {
  s.block.assigns = s.block.assigns_by_name = true;
  const std::size_t begin = s.at;
  s.at += name.size();
  s.skip_blanks();
  if (s.peek() == '[') skip_index(s);
  const Span variable{begin, s.at};
  s.skip_blanks();
  if (s.peek() == '=') take_assigned(s, variable);
}

bool equals_follows(const Scanner& s, std::size_t behind) {
  Scanner ahead = s;
  ahead.at += behind;
  ahead.skip_blanks();
  return ahead.peek() == '=' && (ahead.at + 1 >= s.end || s.text[ahead.at + 1] != '=');
}

void lex_letter(Scanner& s) {
  const char letter = upper(s.peek());
  if (!equals_follows(s, 1)) return lex_word(s);
  const std::size_t words = s.block.words.size();
  read_named_word(s, letter, 1);
  Word& word = s.block.words[words];
  if (letter == 'P') word.value -= 1;
  // An M or S with an expression does not affect moves. A tool with a name has no number.
  if (!word.literal && (letter == 'M' || letter == 'S' || letter == 'H' || letter == 'D'))
    s.block.words.pop_back();
  // An arc whose centre is an expression is not followed.
  if (letter >= 'I' && letter <= 'K' && !word.literal) s.block.statement = Statement::arc_not_read;
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
  for (const SiemensName& known : siemens_names)
    if (is_word(name, known.name)) return state(s, known.statement);
  if (std::any_of(harmless_names.begin(), harmless_names.end(),
                  [&](auto known) { return is_word(name, known); }))
    return skip_harmless(s, name);
  for (const std::string_view family : {"CYCLE", "POCKET", "HOLES", "SLOT", "LONGHOLE"})
    if (is_word(name.substr(0, family.size()), family)) return state(s, Statement::cycle);
  if (name.starts_with('$')) s.block.statement = Statement::data;
  if (name.starts_with('$') || equals_follows(s, name.size()) ||
      s.text.substr(s.at + name.size(), 1) == "[") {
    const bool position = std::any_of(position_names.begin(), position_names.end(),
                                      [&](auto known) { return is_word(name, known); });
    return position ? state(s, Statement::call) : skip_named_assignment(s, name);
  }
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
  const std::string_view name = name_at(s);
  const bool single =
      is_letter(name[0]) && (name.size() == 1 || is_run_of_words(name) || has_digit_behind_letter(name));
  if (lex_label(s, name)) return;
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
