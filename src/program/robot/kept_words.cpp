#include "program/robot/kept_words.hpp"

#include <algorithm>

#include "program/robot/line.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

bool is_before(Span a, Span b) {
  return a.begin < b.begin;
}

bool is_name_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '$' || c == '.';
}

// The end of a bracket at `at`, else `at`.
std::size_t behind_bracket(std::string_view text, std::size_t at) {
  int depth = 0;
  for (std::size_t i = at; i < text.size(); ++i) {
    if (text[i] == '[' || text[i] == '{') ++depth;
    if (text[i] == ']' || text[i] == '}') --depth;
    if (depth == 0) return i > at ? i + 1 : at;
  }
  return at;
}

// The end of a target at `at`: "{X 1}", "[[1,2,3],...]", "P1", "P[3].AT".
std::size_t behind_target(std::string_view text, std::size_t at) {
  for (std::size_t begin = at;; begin = at) {
    while (at < text.size() && is_name_character(text[at])) ++at;
    at = behind_bracket(text, at);
    if (at == begin) return at;
  }
}

// The words of a zone: ",z10", ",[FALSE,0.5,...]" of ABB, ",r=0.001" of Universal Robots.
std::string without_zone(std::string text) {
  for (std::size_t at = 0; (at = text.find(',', at)) != std::string::npos;) {
    const std::string_view rest = std::string_view(text).substr(at + 1);
    std::size_t size = 0;
    if ((rest.starts_with('z') || rest.starts_with('Z')) && rest.size() > 1 && is_digit(rest[1]))
      size = 1 + std::min(rest.find_first_not_of("0123456789", 1), rest.size());
    else if (rest.starts_with("[FALSE") || rest.starts_with("[TRUE"))
      size = 2 + std::min(rest.find(']'), rest.size() - 1);
    else if (rest.starts_with("r="))
      size = 1 + std::min(rest.find_first_not_of("0123456789.eE+-", 2), rest.size());
    if (size > 0)
      text.erase(at, size);
    else
      ++at;
  }
  return text;
}

// "POINTS[12]={...}" without its index: the element of an array in a data list of KUKA. Points that are
// inserted before it change it.
std::string without_index(std::string text) {
  const std::size_t open = text.find('['), close = text.find(']'), equals = text.find('=');
  if (open < close && close < equals && equals != std::string::npos) text.erase(open, close + 1 - open);
  return text;
}

// The statement with '@' for its target, or for the two of an arc.
std::string without_targets(std::string_view statement, bool has_arc) {
  std::size_t head = 0;
  while (head < statement.size() && is_letter(statement[head])) ++head;
  if (head < statement.size() && statement[head] == '(') ++head;  // movel(start, a=1.2)
  std::size_t end = behind_target(statement, behind_blanks(statement, head, statement.size()));
  if (const std::size_t comma = behind_blanks(statement, end, statement.size());
      has_arc && comma < statement.size() && statement[comma] == ',')
    end = behind_target(statement, behind_blanks(statement, comma + 1, statement.size()));
  return std::string(statement.substr(0, head)) + '@' + without_zone(without_spaces(statement.substr(end)));
}

}  // namespace

std::vector<Span> target_numbers(const Move& move) {
  std::vector<Span> numbers;
  const auto add = [&](const PackedAxisWord& word) {
    if (word) numbers.push_back(word->number);
  };
  for (const auto& word : move.words) add(word);
  if (move.orientation)
    for (const auto& word : move.orientation->words) add(word);
  std::sort(numbers.begin(), numbers.end(), is_before);
  return numbers;
}

std::string_view statement_without_comment(const Program& program, const Move& move,
                                           std::string_view comment_mark) {
  const std::string_view block =
      std::string_view(program.text).substr(move.block.begin, move.block.end - move.block.begin);
  bool quoted = false;
  for (std::size_t at = 0; at < block.size(); ++at) {
    if (block[at] == '"') quoted = !quoted;
    if (!quoted && block.substr(at).starts_with(comment_mark)) return block.substr(0, at);
  }
  return block;
}

std::string without_spaces(std::string_view text) {
  std::string rest(text);
  std::erase_if(rest, [](char c) { return c == ' ' || c == '\t'; });
  return rest;
}

std::string statement_kept_words(const Program& program, const Move& move, std::string_view comment_mark) {
  const std::string_view statement = statement_without_comment(program, move, comment_mark);
  const std::size_t begin = move.block.begin, end = begin + statement.size();
  std::vector<Span> numbers = target_numbers(move);
  if (move.arc)
    for (const auto& word : move.arc->centre_words)
      if (word) numbers.push_back(word->number);
  std::sort(numbers.begin(), numbers.end(), is_before);
  const bool is_named = std::any_of(numbers.begin(), numbers.end(), [&](const Span& number) {
    return number.begin < begin || number.end > move.block.end;
  });
  if (is_named)
    return without_targets(statement.substr(behind_blanks(statement, 0, statement.size())),
                           move.arc.has_value());
  std::string text;
  std::size_t at = begin;
  for (const Span& number : numbers) {
    text.append(program.text, at, number.begin - at);
    at = number.end;
  }
  if (end > at) text.append(program.text, at, end - at);
  return without_index(without_zone(without_spaces(text)));
}

}  // namespace counterflex
