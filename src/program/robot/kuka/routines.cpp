#include "program/robot/kuka/routines.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "program/robot/kuka/loops.hpp"
#include "program/robot/kuka/names.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr auto cutting_words = std::to_array<std::string_view>(
    {"LIN", "CIRC", "LIN_REL", "CIRC_REL", "SPLINE", "SLIN", "SCIRC", "SLIN_REL", "SCIRC_REL", "SPL"});
constexpr auto joint_words =
    std::to_array<std::string_view>({"PTP", "PTP_REL", "PTP_SPLINE", "SPTP", "SPTP_REL"});
/// Words that a parenthesis may follow.
constexpr auto no_calls = std::to_array<std::string_view>({
    "BAS",    "IF",  "ELSEIF", "WHILE", "UNTIL",  "SWITCH", "CASE", "FOR",    "WAIT", "SEC",
    "NOT",    "AND", "OR",     "EXOR",  "B_NOT",  "B_AND",  "B_OR", "B_EXOR", "TO",   "STEP",
    "RETURN", "EXT", "EXTFCT", "DEF",   "DEFFCT", "WHEN",   "DO",   "ON",     "OFF",
});
/// Functions of the language and of its strings that change none of their arguments.
constexpr auto pure_functions = std::to_array<std::string_view>({
    "ABS",
    "SQRT",
    "SIN",
    "COS",
    "TAN",
    "ACOS",
    "ATAN",
    "ATAN2",
    "FRAND",
    "INV_POS",
    "EB",
    "EK",
    "EO",
    "LK",
    "VARSTATE",
    "VARTYPE",
    "GETVARSIZE",
    "GETCYCDEF",
    "GETSYSSTATE",
    "GET_AXESMASK",
    "GET_DIAGSTATE",
    "STRLEN",
    "STRDECLLEN",
    "STRCOMP",
    "STRFIND",
    "IS_KEY_PRESSED",
    "EXISTS_KRLMSG",
    "EXISTS_KRLDLG",
    "CLEAR_KRLMSG",
    "PULSE",
});
/// Functions that leave the robot, its frame and its tool, but may change an argument. IR_STOPM is the
/// interrupt routine of the control that the fold INI of its programs declares.
constexpr auto motionless_calls = std::to_array<std::string_view>(
    {"CWRITE",      "CREAD",           "SREAD",          "SWRITE",           "COPEN",
     "CCLOSE",      "CIOCTL",          "CAST_TO",        "CAST_FROM",        "MSG",
     "FORWARD",     "INVERSE",         "STRADD",         "STRCLEAR",         "STRCOPY",
     "STRTOBOOL",   "STRTOINT",        "STRTOREAL",      "STRTOSTRING",      "STRTOFRAME",
     "STRTOPOS",    "STRTOE3POS",      "STRTOE6POS",     "STRTOAXIS",        "STRTOE3AXIS",
     "STRTOE6AXIS", "SET_KRLMSG",      "SET_KRLDLG",     "SET_KRLDLGANSWER", "GET_MSGBUFFER",
     "GET_SIG_INF", "GET_SYSTEM_DATA", "GET_DECL_PLACE", "ERR_CLEAR",        "ERR_RAISE",
     "IR_STOPM"});
/// Files and EthernetKRL.
constexpr auto motionless_prefixes = std::to_array<std::string_view>({"KRL_F", "EKI_"});
/// Those that read values into their arguments.
constexpr auto reading_calls = std::to_array<std::string_view>(
    {"CREAD", "SREAD", "CAST_FROM", "STRTOFRAME", "STRTOPOS", "STRTOE3POS", "STRTOE6POS"});
constexpr auto reading_prefixes = std::to_array<std::string_view>({"KRL_FREAD", "KRL_FSCAN", "EKI_GET"});
constexpr auto speeds =
    std::to_array<std::string_view>({"$VEL", "$ACC", "$APO", "LDAT_ACT", "PDAT_ACT", "$ADVANCE"});
constexpr auto conditions = std::to_array<std::string_view>(
    {"IF", "ELSE", "ELSEIF", "ENDIF", "SWITCH", "CASE", "DEFAULT", "ENDSWITCH", "RETURN", "END", "ENDFCT"});

std::string head_word(std::string_view text, const RobotLine& line) {
  return krl_word(part(text, name_at(text, line.code.begin, line.code.end)));
}

std::string variable_assigned(std::string_view text, const RobotLine& line) {
  const auto assignment = assignment_at(text, line.code.begin, line.code.end);
  return assignment ? krl_word(part(text, assignment->variable)) : "";
}

/// "#BASE" of BAS(#BASE, 5), in upper case; empty for another statement.
std::string question_of_bas(std::string_view text, const RobotLine& line) {
  const Span head = name_at(text, line.code.begin, line.code.end);
  if (krl_word(part(text, head)) != "BAS") return "";
  const std::string code = krl_word(part(text, {head.end, line.code.end}));
  return code.substr(std::min<std::size_t>(code.size(), 1), code.find_first_of(",)", 1) - 1);
}

bool only_sets_speed(std::string_view question) {
  return question.starts_with("#VEL") || question.starts_with("#ACC") || question == "#CP_DAT" ||
         question == "#PTP_DAT";
}

/// The byte of the parenthesis that closes the one at `open`; `end` without it.
std::size_t closing(std::string_view text, std::size_t open, std::size_t end) {
  int depth = 0;
  for (std::size_t at = open; at < end; ++at) {
    if (text[at] == '(' || text[at] == '[' || text[at] == '{') ++depth;
    if (text[at] == ')' || text[at] == ']' || text[at] == '}') --depth;
    if (depth == 0) return at;
  }
  return end;
}

/// The parts of the span between its outer commas.
std::vector<std::string> parts_between_commas(std::string_view text, Span span) {
  std::vector<std::string> parts;
  std::size_t begin = span.begin;
  int depth = 0;
  for (std::size_t at = span.begin; at <= span.end; ++at) {
    if (at < span.end && std::string_view("([{").find(text[at]) != std::string_view::npos) ++depth;
    if (at < span.end && std::string_view(")]}").find(text[at]) != std::string_view::npos) --depth;
    if (at < span.end && (text[at] != ',' || depth > 0)) continue;
    parts.push_back(krl_word(text.substr(begin, at - begin)));
    begin = at + 1;
  }
  return parts;
}

bool begins_with_one_of(std::string_view name, std::span<const std::string_view> prefixes) {
  return std::ranges::any_of(prefixes, [&](std::string_view prefix) { return name.starts_with(prefix); });
}

bool is_variable(std::string_view argument) {
  const Span variable = variable_at(argument, 0, argument.size());
  return !empty(variable) && variable.end == argument.size();
}

}  // namespace

const KrlRoutine* KrlFacts::find(std::string_view name) const {
  const auto found = routines.find(name);
  return found == routines.end() ? nullptr : &found->second;
}

int KrlFacts::changed_in(std::string_view variable) const {
  const std::string element = changed_part(variable);
  for (const std::string_view name :
       {std::string_view(element), std::string_view(element).substr(0, element.find('['))})
    if (const auto found = changed.find(name); found != changed.end()) return found->second;
  return 0;
}

std::string changed_part(std::string_view variable) {
  const std::string word = krl_word(variable);
  const std::size_t open = word.find_first_of(".[");
  if (open == std::string::npos || word[open] == '.') return word.substr(0, open);
  const std::size_t close = word.find(']', open);
  return whole_number(word, {open + 1, std::max(close, open + 1)}) ? word.substr(0, close + 1)
                                                                   : word.substr(0, open);
}

bool is_krl_call(std::string_view text, const RobotLine& line) {
  const Span head = name_at(text, line.code.begin, line.code.end);
  const std::size_t next = behind_blanks(text, head.end, line.code.end);
  return !empty(head) && next < line.code.end && text[next] == '(' &&
         !is_among(krl_word(part(text, head)), no_calls);
}

bool is_motionless_call(std::string_view name) {
  return is_among(name, pure_functions) || is_among(name, motionless_calls) ||
         begins_with_one_of(name, motionless_prefixes);
}

std::vector<KrlCall> krl_calls(std::string_view text, const RobotLine& line) {
  std::vector<KrlCall> calls;
  const std::string head = head_word(text, line);
  const bool declares = begins_routine(text, line) || head == "EXT" || head == "EXTFCT";
  if (declares || part(text, line.code).find('(') == std::string_view::npos) return calls;
  std::string open;  // the brackets around the place
  char before = ' ';
  for (std::size_t at = line.code.begin; at < line.code.end;) {
    const char c = text[at];
    const Span name = name_at(text, at, line.code.end);
    if (empty(name)) {
      if (c == '"') at = std::min(text.find('"', at + 1), line.code.end - 1);
      if (c == '(' || c == '[' || c == '{') open += c;
      if ((c == ')' || c == ']' || c == '}') && !open.empty()) open.pop_back();
      if (!is_blank(c)) before = c;
      ++at;
      continue;
    }
    const std::size_t bracket = behind_blanks(text, name.end, line.code.end);
    // "{X (1+2)}": the name of a component
    const bool is_component = open.ends_with('{') && (before == '{' || before == ',' || before == ':');
    const std::string word = krl_word(part(text, name));
    if (bracket < line.code.end && text[bracket] == '(' && !is_component && !is_among(word, no_calls))
      calls.push_back(
          {name, word, parts_between_commas(text, {bracket + 1, closing(text, bracket, line.code.end)})});
    before = text[name.end - 1];
    at = name.end;
  }
  return calls;
}

bool reads_into(const KrlCall& call, std::string_view variable) {
  const bool reads = is_among(call.word, reading_calls) || begins_with_one_of(call.word, reading_prefixes);
  return reads && std::ranges::any_of(call.arguments, [&](const std::string& argument) {
           return argument == variable ||
                  (argument.starts_with(variable) && argument[variable.size()] == '.');
         });
}

bool may_repeat(std::string_view text, const RobotLine& line) {
  const std::string variable = variable_assigned(text, line);
  if (!variable.empty())
    return std::ranges::any_of(speeds, [&](std::string_view name) { return variable.starts_with(name); });
  const std::string question = question_of_bas(text, line), head = head_word(text, line);
  if (!question.empty()) return only_sets_speed(question);
  return is_among(head, conditions) || begins_declaration(head);
}

void KrlScan::add(std::string_view lines) {
  RobotLine line;
  while (next_robot_line(lines, krl_comment, line)) {
    ++line_;
    if (!empty(line.code) && lines[line.code.begin] != '&') add_statement(lines, line);
  }
}

void KrlScan::begin_routine(std::string_view text, const RobotLine& line) {
  is_first_ = facts_.routines.empty();
  locals_.clear();
  const std::size_t open = std::min(text.find('(', line.code.begin), line.code.end);
  Span name{};
  for (std::size_t at = line.code.begin; at < open;) {
    const Span word = name_at(text, at, open);
    if (!empty(word)) name = word;
    at = empty(word) ? at + 1 : word.end;
  }
  routine_ = &facts_.routines[krl_word(part(text, name))];
  if (open >= line.code.end) return;
  for (const std::string& parameter :
       parts_between_commas(text, {open + 1, closing(text, open, line.code.end)})) {
    const std::size_t kind = parameter.find(':');
    routine_->is_input.push_back(kind != std::string::npos && parameter.substr(kind) == ":IN");
    locals_.insert(parameter.substr(0, std::min(parameter.find('['), kind)));
  }
}

void KrlScan::add_statement(std::string_view text, const RobotLine& line) {
  if (begins_routine(text, line)) return begin_routine(text, line);
  if (routine_ == nullptr) return;
  const std::string head = head_word(text, line);
  const bool cuts = is_among(head, cutting_words);
  routine_->cuts = routine_->cuts || cuts;
  routine_->moves = routine_->moves || cuts || is_among(head, joint_words);
  add_calls(text, line);
  if (begins_declaration(head))
    for (std::size_t at = line.code.begin; at < line.code.end;) {
      const Span name = name_at(text, at, line.code.end);
      if (!empty(name)) locals_.insert(krl_word(part(text, name)));
      at = empty(name) ? at + 1 : name.end;
    }
  const std::string variable = variable_assigned(text, line), question = question_of_bas(text, line);
  const bool selects = !question.empty() && !only_sets_speed(question);
  routine_->selects_frame =
      routine_->selects_frame || variable.starts_with("$BASE") || (selects && question != "#TOOL");
  routine_->selects_tool =
      routine_->selects_tool || variable.starts_with("$TOOL") || (selects && question != "#BASE");
  routine_->sets_speed = routine_->sets_speed || variable.starts_with("$VEL") || question == "#VEL_CP" ||
                         question == "#CP_PARAMS";
  routine_->sets_turns =
      routine_->sets_turns || variable == "$ORI_TYPE" || question == "#CP_PARAMS" || question == "#CP_DAT";
  routine_->sets_circle = routine_->sets_circle || variable == "$CIRC_TYPE";
  const bool is_own = !variable.empty() && is_local(variable);
  routine_->acts = routine_->acts || !(is_own || may_repeat(text, line) || is_krl_call(text, line));
  const std::string changed = changed_part(variable);
  const bool computed = variable.find('[') != std::string::npos && changed.find('[') == std::string::npos;
  if (!variable.empty() && (is_first_ ? computed : !is_own)) add_change(changed, line_);
}

void KrlScan::add_calls(std::string_view text, const RobotLine& line) {
  for (const KrlCall& call : krl_calls(text, line)) {
    routine_->calls.insert(call.word);
    routine_->selects_frame = routine_->selects_frame || reads_into(call, "$BASE");
    routine_->selects_tool = routine_->selects_tool || reads_into(call, "$TOOL");
    if (is_among(call.word, pure_functions)) continue;
    for (std::size_t i = 0; i < call.arguments.size(); ++i)
      add_argument(call.word, i, call.arguments[i], line_);
  }
}

void KrlScan::add_argument(const std::string& callee, std::size_t index, std::string_view argument,
                           int line) {
  if (is_variable(argument) && (is_first_ || !is_local(argument)))
    arguments_.try_emplace({callee, index, changed_part(argument)}, line);
}

void KrlScan::add_change(std::string_view variable, int line) {
  facts_.changed.try_emplace(std::string(variable), line);
}

bool KrlScan::is_local(std::string_view variable) const {
  return locals_.contains(variable.substr(0, variable.find_first_of(".[")));
}

// A routine of another file may move the robot, also as a function of an expression.
KrlRoutine KrlScan::called(const std::string& name) const {
  if (const KrlRoutine* const known = facts_.find(name)) return *known;
  const bool unread = !is_motionless_call(name) && !harmless_.contains(name);
  return {.moves = unread, .calls_unread = unread, .acts = true};
}

void KrlScan::close_over_calls() {
  bool grows = false;
  const auto add = [&](bool& has, bool more) {
    grows = grows || (more && !has);
    has = has || more;
  };
  do {
    grows = false;
    for (auto& entry : facts_.routines)
      for (const std::string& call : entry.second.calls) {
        const KrlRoutine of = called(call);
        add(entry.second.moves, of.moves);
        add(entry.second.cuts, of.cuts);
        add(entry.second.calls_unread, of.calls_unread);
        add(entry.second.selects_frame, of.selects_frame);
        add(entry.second.selects_tool, of.selects_tool);
        add(entry.second.sets_speed, of.sets_speed);
        add(entry.second.sets_turns, of.sets_turns);
        add(entry.second.sets_circle, of.sets_circle);
        add(entry.second.acts, of.acts);
      }
  } while (grows);
}

KrlFacts KrlScan::finish() {
  close_over_calls();
  for (const auto& [argument, line] : arguments_) {
    const KrlRoutine* const called = facts_.find(argument.callee);
    const bool is_input =
        called != nullptr && argument.index < called->is_input.size() && called->is_input[argument.index];
    if (!is_input) add_change(argument.variable, line);
  }
  return std::move(facts_);
}

KrlFacts krl_facts_of(std::string_view text) {
  const CallNames harmless;
  KrlScan scan(harmless);
  scan.add(text.substr(0, data_list_at(text)));
  return scan.finish();
}

}  // namespace counterflex
