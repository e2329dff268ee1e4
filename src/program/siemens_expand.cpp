#include "program/siemens_expand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "counterflex/program/called_cycle.hpp"
#include "program/constant_expression.hpp"
#include "program/evaluate.hpp"
#include "program/expand_lines.hpp"
#include "program/scanner.hpp"

namespace counterflex {
namespace {

constexpr std::size_t most_lines = 150'000, most_bytes = 16'000'000;

std::string upper_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), upper);
  return result;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r"), text.size());
  return text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
}

/// Takes the name at the begin of `text` off, with the blanks behind it.
std::string take_name(std::string_view& text) {
  std::size_t end = 0;
  while (end < text.size() && (is_letter(text[end]) || is_digit(text[end]) || text[end] == '_')) ++end;
  const std::string name = upper_case(text.substr(0, end));
  text = trimmed(text.substr(end));
  return name;
}

/// "IF R1<3 GOTOB BEGIN": the place of the word GOTO, GOTOB, GOTOF or GOTOC; npos where there is none.
std::size_t jump_in(const std::string& line) {
  for (std::size_t at = line.find("GOTO"); at != std::string::npos; at = line.find("GOTO", at + 1))
    if (at == 0 || is_blank(line[at - 1]) || line[at - 1] == ')') return at;
  return std::string::npos;
}

/// A line, and what it says of the line that is executed next.
struct Line {
  Span span;                ///< with its end
  int number = 0;           ///< of the file
  Span label;               ///< with ':'
  std::string keyword;      ///< IF, FOR, ... GOTO; empty: any other block
  std::string condition;    ///< of IF, WHILE, UNTIL; "R1=1 TO 5" of FOR
  std::string target;       ///< label of a jump
  std::size_t partner = 0;  ///< line of the keyword that ends or begins the structure
  std::size_t other = 0;    ///< of IF: the line of ELSE, or of ENDIF
  bool ends = false;        ///< M2, M30, M17, RET
  bool counted = false;     ///< it has been executed
};

/// What a run cannot go on from.
struct Unknown {
  int line;
  std::string why;
};

class Run {
 public:
  Run(std::string_view text, const std::string& file, const Dialect& dialect)
      : text_(text), file_(file), dialect_(dialect), out_{{}, line_end_of(text)} {}

  /// Whether any line is a loop, a condition or a jump.
  bool read() {
    Block block;
    while (next_line(text_, block)) {
      lex(text_, file_, dialect_, block);
      add(block);
    }
    join_structures();
    return std::any_of(lines_.begin(), lines_.end(), [](const Line& line) { return !line.keyword.empty(); });
  }

  Expansion execute(std::string& text) {
    std::size_t executed = 0;
    for (std::size_t at = 0; at < lines_.size();) {
      if (++executed > most_lines || out_.text.size() > most_bytes)
        throw Unknown{jumped_from_, fmt::format("more than {} lines would be executed", most_lines)};
      if (lines_[at].ends) {
        for (; at < lines_.size(); ++at) out_.append(part(text_, lines_[at].span), lines_[at].number, 0);
        break;
      }
      at = step(at);
    }
    Expansion expansion;
    expansion.lines = std::move(out_.runs);
    expansion.file_lines = static_cast<int>(lines_.size());
    expansion.calls = jumps_;
    expansion.first_call = first_jump_;
    text = std::move(out_.text);
    return expansion;
  }

 private:
  void add(const Block& block) {
    Line line;
    line.span = {block.span.begin, block.line_end.end};
    line.number = block.line;
    std::string_view rest = part(text_, block.span);
    rest = rest.substr(0, comment_at(rest));
    const char* const begin = text_.data();
    rest = trimmed(rest);
    const bool skipped = rest.starts_with('/');
    if (skipped) rest = trimmed(rest.substr(std::min(rest.find_first_not_of("/0123456789"), rest.size())));
    if (rest.size() > 1 && upper(rest[0]) == 'N' && is_digit(rest[1]))
      rest = trimmed(rest.substr(std::min(rest.find_first_not_of("0123456789", 1), rest.size())));
    std::string_view ahead = rest;
    const std::string name = take_name(ahead);
    if (!name.empty() && !is_digit(name[0]) && ahead.starts_with(':') && !ahead.starts_with(":=")) {
      const auto at = static_cast<std::size_t>(rest.data() - begin);
      line.label = {at, static_cast<std::size_t>(ahead.data() - begin) + 1};
      labels_[name].push_back(lines_.size());
      rest = trimmed(ahead.substr(1));
    }
    read_keyword(rest, line);
    if (skipped && !line.keyword.empty())
      throw Unknown{line.number, "a jump or a loop stands in a block that '/' may skip"};
    line.ends = ends_program(block);
    lines_.push_back(std::move(line));
  }

  static std::size_t comment_at(std::string_view line) {
    bool quoted = false;
    std::size_t at = 0;
    for (; at < line.size() && (quoted || line[at] != ';'); ++at)
      if (line[at] == '"') quoted = !quoted;
    return at;
  }

  static bool ends_program(const Block& block) {
    if (block.statement == Statement::end) return true;
    return std::any_of(block.words.begin(), block.words.end(), [](const Word& word) {
      return word.letter == 'M' && word.literal && (word.value == 2 || word.value == 17 || word.value == 30);
    });
  }

  static void read_keyword(std::string_view rest, Line& line) {
    const std::string statement = upper_case(rest);
    std::string_view after = statement;
    const std::string name = take_name(after);
    const std::size_t jump = jump_in(statement);
    if (name == "IF" && jump != std::string::npos) {
      line.keyword = "GOTO";
      line.condition = trimmed(std::string_view(statement).substr(2, jump - 2));
    } else if (jump == 0) {
      line.keyword = "GOTO";
    } else if (jump != std::string::npos) {
      line.keyword = "GOTO behind other words";
    } else if (name == "REPEAT" && !after.empty()) {
      line.keyword = "REPEATB";
    } else {
      for (const std::string_view known : {"IF", "ELSE", "ENDIF", "FOR", "ENDFOR", "WHILE", "ENDWHILE",
                                           "LOOP", "ENDLOOP", "REPEAT", "UNTIL", "REPEATB", "CASE"})
        if (name == known) line.keyword = name, line.condition = std::string(after);
      return;
    }
    if (line.keyword != "GOTO") return;
    std::string_view words = std::string_view(statement).substr(jump);
    const std::string direction = take_name(words);
    line.target = direction == "GOTOS" ? "" : (direction + " ") + take_name(words);
  }

  void join_structures() {
    std::vector<std::size_t> open;
    const auto close = [&](std::size_t at, std::string_view opening) {
      if (open.empty() || lines_[open.back()].keyword != opening)
        throw Unknown{lines_[at].number, fmt::format("{} ends nothing", lines_[at].keyword)};
      lines_[open.back()].partner = at;
      lines_[at].partner = open.back();
      open.pop_back();
    };
    for (std::size_t at = 0; at < lines_.size(); ++at) {
      const std::string& keyword = lines_[at].keyword;
      if (keyword == "IF" || keyword == "FOR" || keyword == "WHILE" || keyword == "LOOP" ||
          keyword == "REPEAT")
        open.push_back(at);
      if (keyword == "ELSE" && !open.empty()) lines_[open.back()].other = at;
      if (keyword == "ENDIF") {
        close(at, "IF");
        Line& opened = lines_[lines_[at].partner];
        if (opened.other != 0) lines_[opened.other].partner = at;
        if (opened.other == 0) opened.other = at;
      }
      if (keyword == "ENDFOR") close(at, "FOR");
      if (keyword == "ENDWHILE") close(at, "WHILE");
      if (keyword == "ENDLOOP") close(at, "LOOP");
      if (keyword == "UNTIL") close(at, "REPEAT");
    }
    if (!open.empty())
      throw Unknown{lines_[open.back()].number, fmt::format("{} has no end", lines_[open.back()].keyword)};
  }

  /// Executes a line; the one that follows it.
  std::size_t step(std::size_t at) {
    const Line& line = lines_[at];
    const std::string& keyword = line.keyword;
    if (keyword.empty()) return emit(at), at + 1;
    note_jump(line);
    if (keyword == "GOTO") return line.condition.empty() || holds(line) ? target_of(at) : at + 1;
    if (keyword == "IF") return (holds(line) ? at : line.other) + 1;
    if (keyword == "ELSE") return line.partner + 1;
    if (keyword == "WHILE") return (holds(line) ? at : line.partner) + 1;
    if (keyword == "ENDWHILE" || keyword == "ENDLOOP") return line.partner;
    if (keyword == "UNTIL") return holds(line) ? at + 1 : line.partner + 1;
    if (keyword == "FOR") return begin_count(at);
    if (keyword == "ENDFOR") return go_on_counting(line);
    if (keyword == "REPEATB" || keyword == "CASE" || keyword == "GOTO behind other words")
      throw Unknown{line.number, fmt::format("{} is not followed", keyword)};
    return at + 1;  // LOOP, REPEAT, ENDIF
  }

  void note_jump(const Line& line) {
    if (jumps_++ == 0) first_jump_ = line.number;
    jumped_from_ = line.number;
  }

  /// A copy of a line has been executed before.
  void emit(std::size_t at) {
    Line& line = lines_[at];
    Block block;
    block.line_end = {line.span.begin, line.span.begin};
    next_line(text_, block);
    lex(text_, file_, dialect_, block);
    const std::string text = empty(line.label) ? std::string(part(text_, line.span))
                                               : line_without(text_, dialect_, block, {line.label});
    if (!text.empty()) out_.append(text, line.number, line.counted ? jumped_from_ : 0);
    line.counted = true;
    assign(block);
  }

  /// Subprograms may set any variable, and so may a macro that every position calls.
  void assign(const Block& block) {
    if (block.statement == Statement::modal_call)
      calls_macro_ = !block.statement_is_bare && !modal_drilling_cycle(trimmed(part(text_, block.statement_text)));
    if (calls_macro_ || block.statement == Statement::call) variables_.clear();
    for (const Assignment& assignment : block.assignments) {
      const std::string name = variable_name(dialect_, part(text_, assignment.variable));
      if (name.empty()) variables_.clear();
      const auto value = empty(block.block_delete) ? value_of(part(text_, assignment.value)) : std::nullopt;
      if (value && !name.empty())
        variables_[name] = *value;
      else
        variables_.erase(name);
    }
  }

  std::optional<double> value_of(std::string_view expression) const {
    return constant_value(expression, ExpressionSyntax::parentheses, [&](const std::string& name) {
      const auto found = variables_.find(name);
      return found == variables_.end() ? std::nullopt : std::optional<double>(found->second);
    });
  }

  bool holds(const Line& line) const {
    if (const auto truth = truth_of(line.condition)) return *truth;
    throw Unknown{line.number, fmt::format("the condition {} is not known from the text", line.condition)};
  }

  /// Where `word` stands between blanks or brackets, outside brackets; npos where it does not.
  static std::size_t find_outside(std::string_view text, std::string_view word) {
    const bool letters = is_letter(word[0]);
    int depth = 0;
    for (std::size_t at = 0; at + word.size() <= text.size(); ++at) {
      if (text[at] == '(' || text[at] == '[') ++depth;
      if (text[at] == ')' || text[at] == ']') --depth;
      if (depth > 0 || text.substr(at, word.size()) != word) continue;
      const auto is_edge = [&](std::size_t i) {
        return i >= text.size() || (!is_letter(text[i]) && !is_digit(text[i]) && text[i] != '_');
      };
      if (!letters || ((at == 0 || is_edge(at - 1)) && is_edge(at + word.size()))) return at;
    }
    return std::string_view::npos;
  }

  std::optional<bool> truth_of(std::string_view condition) const {
    condition = trimmed(condition);
    for (const std::string_view word : {"OR", "AND"})
      if (const std::size_t at = find_outside(condition, word); at != std::string_view::npos) {
        const auto left = truth_of(condition.substr(0, at)),
                   right = truth_of(condition.substr(at + word.size()));
        if (!left || !right) return std::nullopt;
        return word == "OR" ? *left || *right : *left && *right;
      }
    if (find_outside(condition, "NOT") == 0) {
      const auto inner = truth_of(condition.substr(3));
      return inner ? std::optional(!*inner) : std::nullopt;
    }
    for (const std::string_view sign : {"==", "<>", "<=", ">=", "<", ">"})
      if (const std::size_t at = find_outside(condition, sign); at != std::string_view::npos)
        return compared(value_of(condition.substr(0, at)), sign,
                        value_of(condition.substr(at + sign.size())));
    if (condition.starts_with('(') && condition.ends_with(')'))
      return truth_of(condition.substr(1, condition.size() - 2));
    return std::nullopt;
  }

  static std::optional<bool> compared(std::optional<double> a, std::string_view sign,
                                      std::optional<double> b) {
    if (!a || !b) return std::nullopt;
    if (sign == "==") return *a == *b;
    if (sign == "<>") return *a != *b;
    if (sign == "<=") return *a <= *b;
    if (sign == ">=") return *a >= *b;
    return sign == "<" ? *a < *b : *a > *b;
  }

  std::size_t target_of(std::size_t from) const {
    const Line& line = lines_[from];
    std::string_view words = line.target;
    const std::string direction = take_name(words);
    const auto found = labels_.find(std::string(words));
    if (found == labels_.end())
      throw Unknown{line.number, fmt::format("the label {} of the jump is not found", words)};
    const std::vector<std::size_t>& places = found->second;
    const auto behind = std::upper_bound(places.begin(), places.end(), from);
    const bool forward = behind != places.end(), backward = behind != places.begin();
    if (direction != "GOTOB" && forward) return *behind;
    if (direction != "GOTOF" && backward) return *std::prev(behind);
    throw Unknown{line.number, fmt::format("the label {} of the jump is not found in its direction", words)};
  }

  /// FOR R1=1 TO 5: the variable is set before each time, and the loop ends behind the last value.
  std::size_t begin_count(std::size_t at) {
    const Line& line = lines_[at];
    const std::size_t equals = line.condition.find('='), to = find_outside(line.condition, "TO");
    if (equals == std::string::npos || to == std::string_view::npos || to < equals)
      throw Unknown{line.number, "FOR is written otherwise than FOR variable = begin TO end"};
    const auto first = value_of(std::string_view(line.condition).substr(equals + 1, to - equals - 1));
    if (!first)
      throw Unknown{line.number,
                    fmt::format("the begin of FOR {} is not known from the text", line.condition)};
    return count(at, *first);
  }

  std::size_t go_on_counting(const Line& end) {
    const Line& line = lines_[end.partner];
    const auto now =
        variables_.find(counter_of(line));
    if (now == variables_.end()) throw Unknown{end.number, "the variable of FOR is not known here"};
    return count(end.partner, now->second + 1);
  }

  std::string counter_of(const Line& line) const {
    const std::string name = variable_name(dialect_, std::string_view(line.condition).substr(0, line.condition.find('=')));
    if (name.empty()) throw Unknown{line.number, "the variable of FOR is worked out, or the control's own"};
    return name;
  }

  std::size_t count(std::size_t at, double value) {
    const Line& line = lines_[at];
    const std::string name(trimmed(std::string_view(line.condition).substr(0, line.condition.find('='))));
    const auto last =
        value_of(std::string_view(line.condition).substr(find_outside(line.condition, "TO") + 2));
    if (!last)
      throw Unknown{line.number, fmt::format("the end of FOR {} is not known from the text", line.condition)};
    variables_[counter_of(line)] = value;
    out_.append(fmt::format("{}={}{}", name, shortest_text(value), out_.line_end), line.number, line.number);
    return (value > *last ? line.partner : at) + 1;
  }

  const std::string_view text_;
  const std::string& file_;
  const Dialect& dialect_;
  ExpandedLines out_;
  std::vector<Line> lines_;
  std::map<std::string, std::vector<std::size_t>> labels_;
  std::map<std::string, double> variables_;
  std::size_t jumps_ = 0;
  int first_jump_ = 0, jumped_from_ = 0;
  bool calls_macro_ = false;
};

}  // namespace

Expansion expand_siemens(std::string& text, const std::string& file, const Dialect& dialect) {
  try {
    Run run(text, file, dialect);
    if (!run.read()) return {};
    return run.execute(text);
  } catch (const Unknown& unknown) {
    Expansion expansion;
    expansion.calls_left.push_back({unknown.line, unknown.why});
    return expansion;
  }
}

}  // namespace counterflex
