#include "program/robot/rapid/statement.hpp"

#include <array>

#include "program/text/lex.hpp"

namespace counterflex {
namespace {

constexpr auto routine_begins = std::to_array<std::string_view>({"PROC", "FUNC", "TRAP"});
constexpr auto routine_ends = std::to_array<std::string_view>({"ENDPROC", "ENDFUNC", "ENDTRAP"});
constexpr auto handler_begins = std::to_array<std::string_view>({"ERROR", "UNDO", "BACKWARD"});
constexpr auto loop_begins = std::to_array<std::string_view>({"FOR", "WHILE"});
constexpr auto ends_of_bodies = std::to_array<std::string_view>({"ENDIF", "ENDFOR", "ENDWHILE", "ENDTEST"});
constexpr auto case_words = std::to_array<std::string_view>({"CASE", "DEFAULT"});
constexpr auto data_words = std::to_array<std::string_view>({"VAR", "PERS", "CONST", "ALIAS"});

std::string word_of(std::string_view text, const RapidToken& token) {
  return token.kind == RapidTokenKind::name ? rapid_word(part(text, token.span)) : std::string();
}

/// Ends a statement at the tokens that `ends` accepts. `includes`: the last token belongs to it.
template <typename Ends>
void end_at(std::string_view text, std::size_t end, bool includes, RapidStatement& statement,
            const Ends& ends) {
  std::size_t at = statement.rest;
  statement.span.end = at;
  for (;;) {
    const RapidToken token = rapid_token_at(text, at, end);
    statement.ended = token.kind != RapidTokenKind::none;
    statement.behind = token.span.end;
    if (!statement.ended) return;
    const bool last = ends(token);
    if (!last || includes) statement.span.end = token.span.end;
    if (last && !includes) statement.behind = token.span.begin;
    if (last) return;
    at = token.span.end;
  }
}

void end_at_semicolon(std::string_view text, std::size_t end, RapidStatement& statement) {
  end_at(text, end, false, statement, [&](const RapidToken& token) { return is_symbol(text, token, ';'); });
  if (statement.ended) ++statement.behind;
}

void end_at_word(std::string_view text, std::size_t end, std::string_view word, RapidStatement& statement) {
  end_at(text, end, true, statement, [&](const RapidToken& token) { return word_of(text, token) == word; });
}

/// Ends a statement behind the bracket that closes the first one.
void end_at_bracket(std::string_view text, std::size_t end, RapidStatement& statement) {
  int depth = 0;
  end_at(text, end, true, statement, [&](const RapidToken& token) {
    if (is_symbol(text, token, '(')) ++depth;
    return is_symbol(text, token, ')') && --depth <= 0;
  });
}

void end_at_head(RapidStatement& statement) {
  statement.span.end = statement.behind = statement.rest;
}

/// MODULE name, with attributes in brackets or without.
void end_module_head(std::string_view text, std::size_t end, RapidStatement& statement) {
  statement.rest = rapid_token_at(text, statement.rest, end).span.end;
  if (is_symbol(text, rapid_token_at(text, statement.rest, end), '(')) {
    end_at_bracket(text, end, statement);
    return;
  }
  end_at_head(statement);
}

/// IF condition THEN, or IF condition statement;
void end_condition(std::string_view text, std::size_t end, RapidStatement& statement) {
  bool body = false;
  end_at(text, end, true, statement, [&](const RapidToken& token) {
    body = word_of(text, token) == "THEN";
    return body || is_symbol(text, token, ';');
  });
  statement.kind = body ? RapidKind::body_begin : RapidKind::short_if;
  if (!body && statement.ended) --statement.span.end;
}

void end_routine_head(std::string_view text, std::size_t end, RapidStatement& statement) {
  statement.kind = RapidKind::routine_begin;
  if (statement.head != "TRAP") return end_at_bracket(text, end, statement);
  statement.rest = rapid_token_at(text, statement.rest, end).span.end;
  end_at_head(statement);
}

void end_cases(std::string_view text, std::size_t end, RapidStatement& statement) {
  const bool is_test = statement.head == "TEST";
  end_at(text, end, !is_test, statement, [&](const RapidToken& token) {
    return is_test ? is_among(word_of(text, token), case_words) : is_symbol(text, token, ':');
  });
  if (is_test) statement.ended = true;
}

/// A label, an assignment or a call.
void end_other(std::string_view text, std::size_t end, RapidStatement& statement) {
  const RapidToken next = rapid_token_at(text, statement.rest, end);
  if (is_symbol(text, next, ':')) {
    statement.kind = RapidKind::label;
    statement.span.end = statement.behind = next.span.end;
    return;
  }
  const Span variable = rapid_variable_at(text, statement.span.begin, end);
  const bool assigns =
      !empty(variable) && rapid_token_at(text, variable.end, end).kind == RapidTokenKind::assign;
  statement.kind = assigns ? RapidKind::assignment : RapidKind::call;
  end_at_semicolon(text, end, statement);
}

constexpr std::string_view format_mark = "%%%";

/// "%%% VERSION:1 LANGUAGE:ENGLISH %%%" before a module.
void end_format(std::string_view text, std::size_t end, RapidStatement& statement) {
  statement.kind = RapidKind::declaration;
  const std::size_t close = text.find(format_mark, statement.span.begin + format_mark.size());
  statement.ended = close < end;
  statement.span.end = statement.behind = statement.ended ? close + format_mark.size() : end;
}

void end_keyword(RapidKind kind, RapidStatement& statement) {
  statement.kind = kind;
  end_at_head(statement);
}

}  // namespace

RapidStatement rapid_statement_at(std::string_view text, std::size_t at, std::size_t end) {
  RapidToken first = rapid_token_at(text, at, end);
  while (is_symbol(text, first, ';')) first = rapid_token_at(text, first.span.end, end);  // empty statements
  RapidStatement s{.span = first.span, .rest = first.span.end, .behind = first.span.end};
  if (first.kind == RapidTokenKind::none) return s;
  if (text.substr(first.span.begin, format_mark.size()) == format_mark) {
    end_format(text, end, s);
    return s;
  }
  s.head = word_of(text, first);
  if (s.head == "LOCAL" || s.head == "TASK") {
    first = rapid_token_at(text, s.rest, end);
    s.head = word_of(text, first);
    s.rest = first.span.end;
  }
  if (is_among(s.head, routine_begins)) {
    end_routine_head(text, end, s);
  } else if (is_among(s.head, routine_ends)) {
    end_keyword(RapidKind::routine_end, s);
  } else if (is_among(s.head, ends_of_bodies)) {
    end_keyword(RapidKind::body_end, s);
  } else if (s.head == "ELSE") {
    end_keyword(RapidKind::branch, s);
  } else if (s.head == "ENDMODULE") {
    end_keyword(RapidKind::module_end, s);
  } else if (is_among(s.head, handler_begins)) {
    s.kind = RapidKind::handler;
    is_symbol(text, rapid_token_at(text, s.rest, end), '(') ? end_at_bracket(text, end, s) : end_at_head(s);
  } else if (s.head == "MODULE") {
    s.kind = RapidKind::module_begin;
    end_module_head(text, end, s);
  } else if (s.head == "IF") {
    end_condition(text, end, s);
  } else if (s.head == "ELSEIF") {
    s.kind = RapidKind::branch;
    end_at_word(text, end, "THEN", s);
  } else if (is_among(s.head, loop_begins)) {
    s.kind = RapidKind::body_begin;
    end_at_word(text, end, "DO", s);
  } else if (s.head == "TEST" || is_among(s.head, case_words)) {
    s.kind = s.head == "TEST" ? RapidKind::body_begin : RapidKind::branch;
    end_cases(text, end, s);
  } else if (s.head == "RECORD") {
    s.kind = RapidKind::declaration;
    end_at_word(text, end, "ENDRECORD", s);
  } else if (is_among(s.head, data_words)) {
    s.kind = RapidKind::declaration;
    end_at_semicolon(text, end, s);
  } else {
    end_other(text, end, s);
  }
  return s;
}

bool has_expressions(RapidKind kind) {
  switch (kind) {
    case RapidKind::body_begin:
    case RapidKind::branch:
    case RapidKind::short_if:
    case RapidKind::declaration:
    case RapidKind::assignment:
    case RapidKind::call:
      return true;
    default:
      return false;
  }
}

std::size_t statement_of_short_if(std::string_view text, const RapidStatement& statement) {
  constexpr auto operators = std::to_array<std::string_view>({"AND", "OR", "XOR", "NOT", "DIV", "MOD"});
  bool operand = false;
  for (std::size_t at = statement.rest; at < statement.span.end;) {
    const RapidToken token = rapid_token_at(text, at, statement.span.end);
    if (token.kind == RapidTokenKind::none) break;
    const bool is_operator = is_among(word_of(text, token), operators);
    if (token.kind == RapidTokenKind::name && !is_operator && operand) return token.span.begin;
    const char c = text[token.span.begin];
    operand = token.kind == RapidTokenKind::symbol ? c == ')' || c == '}' || c == ']' : !is_operator;
    if (token.kind == RapidTokenKind::assign) operand = false;
    at = token.span.end;
  }
  return statement.span.end;
}

RapidDeclaration rapid_declaration(std::string_view text, const RapidStatement& statement) {
  RapidDeclaration declaration;
  const std::size_t end = statement.span.end;
  if (statement.kind != RapidKind::declaration) return declaration;
  if (statement.head != "VAR" && statement.head != "PERS" && statement.head != "CONST") return declaration;
  const RapidToken type = rapid_token_at(text, statement.rest, end);
  const RapidToken name = rapid_token_at(text, type.span.end, end);
  if (type.kind != RapidTokenKind::name || name.kind != RapidTokenKind::name) return declaration;
  declaration.type = word_of(text, type);
  declaration.name = name.span;
  declaration.constant = statement.head == "CONST";
  const Span variable = rapid_variable_at(text, name.span.begin, end);
  declaration.array = variable.end != name.span.end;
  const RapidToken assign = rapid_token_at(text, variable.end, end);
  if (assign.kind == RapidTokenKind::assign)
    declaration.value = {rapid_token_at(text, assign.span.end, end).span.begin, end};
  return declaration;
}

}  // namespace counterflex
