#include "program/robot/kept_words.hpp"

#include <algorithm>

#include "program/robot/line.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

bool is_before(Span a, Span b) {
  return a.begin < b.begin;
}

bool is_one_of(char c, std::string_view characters) {
  return characters.find(c) != std::string_view::npos;
}

bool is_name_character(char c) {
  return is_letter(c) || is_digit(c) || is_one_of(c, "_$.");
}

bool is_within(Span inner, Span outer) {
  return inner.begin >= outer.begin && inner.end <= outer.end;
}

// The end of a bracket at `at`, else `at`.
std::size_t behind_bracket(std::string_view text, std::size_t at) {
  int depth = 0;
  for (std::size_t i = at; i < text.size(); ++i) {
    if (is_one_of(text[i], "[{")) ++depth;
    if (is_one_of(text[i], "]}")) --depth;
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

// "POINTS[12]={...}" without its index: the element of an array in a data list of KUKA. Points that are
// inserted before it change it.
std::string without_index(std::string text) {
  const std::size_t open = text.find('['), close = text.find(']'), equals = text.find('=');
  if (open < close && close < equals && equals != std::string::npos) text.erase(open, close + 1 - open);
  return text;
}

// Without commas that separate nothing: of numbers that were left out.
std::string without_empty_places(std::string_view text) {
  std::string kept;
  for (const char c : text) {
    const bool behind_open = !kept.empty() && is_one_of(kept.back(), "{,/");
    if (c == ',' && behind_open) continue;
    if (c == '}' && !kept.empty() && kept.back() == ',') kept.pop_back();
    kept += c;
  }
  while (kept.ends_with(',')) kept.pop_back();
  return kept;
}

// The declared target around the number at `number`: the smallest bracket if numbers have names, as it may be
// in a structure; else the largest one of its statement, with the letter of a pose.
Span target_around(std::string_view text, std::size_t number, const StatementForm& form) {
  if (form.has_named_numbers) {
    const std::size_t begin = text.rfind('{', number);
    return {begin == std::string_view::npos ? number : begin,
            std::min(text.find('}', number), text.size() - 1) + 1};
  }
  int depth = 0;
  std::size_t begin = number;
  for (std::size_t i = number; i-- > 0 && !is_one_of(text[i], "=;)(");) {
    if (text[i] == ']') ++depth;
    if (text[i] == '[' && depth-- <= 0) {
      begin = i;
      depth = 0;
    }
  }
  const bool is_pose = begin > 0 && text[begin - 1] == 'p';
  return {begin - (is_pose ? 1 : 0), behind_bracket(text, begin)};
}

// The name to which the text gives `target`: "XP1={...}", "p1:=[[...]]", "p1 = p[...]".
std::string_view name_of_declared(std::string_view text, Span target) {
  std::size_t end = target.begin;
  while (end > 0 && is_one_of(text[end - 1], " \t=:\r\n")) --end;
  std::size_t begin = end;
  if (begin > 0 && text[begin - 1] == ']') begin = std::min(text.rfind('[', begin), begin);
  while (begin > 0 && is_name_character(text[begin - 1])) --begin;
  return text.substr(begin, end - begin);
}

// Where a statement has `name`, as a whole word of any case; npos without it.
std::size_t place_of_name(std::string_view statement, std::string_view name) {
  const auto same = [](char a, char b) { return upper(a) == upper(b); };
  for (auto from = statement.begin(); !name.empty(); ++from) {
    from = std::search(from, statement.end(), name.begin(), name.end(), same);
    if (from == statement.end()) break;
    const auto at = static_cast<std::size_t>(from - statement.begin());
    const std::size_t end = at + name.size();
    const bool begins = at == 0 || !is_name_character(statement[at - 1]);
    if (begins && (end >= statement.size() || !is_name_character(statement[end]) || statement[end] == '.'))
      return at;
  }
  return std::string_view::npos;
}

// A target that is declared elsewhere, for its name in a statement.
struct NamedTarget {
  Span name;
  std::string words;
};

std::vector<NamedTarget> named_targets(std::string_view text, Span statement,
                                       const std::vector<Span>& numbers, const StatementForm& form) {
  std::vector<NamedTarget> targets;
  const std::string_view own = part(text, statement);
  for (std::size_t behind = 0; const Span& number : numbers) {
    if (number.begin < behind || is_within(number, statement)) continue;
    const Span target = target_around(text, number.begin, form);
    behind = target.end;
    const std::size_t at = place_of_name(own, name_of_declared(text, target));
    if (at == std::string_view::npos) continue;
    targets.push_back({{statement.begin + at, statement.begin + behind_target(own, at)},
                       target_kept_words(text, target, numbers, form)});
  }
  std::sort(targets.begin(), targets.end(),
            [](const NamedTarget& a, const NamedTarget& b) { return is_before(a.name, b.name); });
  return targets;
}

// The statement of an arc as that of a line to its end, and its auxiliary point behind a mark:
// "CIRC{},{}C_DIS" becomes "LIN{}C_DIS|{}".
std::string as_line(std::string text) {
  std::size_t head = 0;
  while (head < text.size() && is_letter(text[head])) ++head;
  if (head == 0 || head == text.size()) return text;
  if (upper(text[0]) == 'C') {
    text.replace(0, head, text[0] == 'c' ? "lin" : "LIN");
    head = 3;
  } else {
    text[head - 1] = text[head - 1] == 'c' ? 'l' : 'L';
  }
  if (text[head] == '(') ++head;
  int depth = 0;
  std::size_t comma = head;
  for (; comma < text.size() && (depth > 0 || text[comma] != ','); ++comma)
    depth += is_one_of(text[comma], "([{") ? 1 : is_one_of(text[comma], ")]}") ? -1 : 0;
  const std::string auxiliary = text.substr(head, comma - head);
  text.erase(head, comma + 1 - head);
  return text + auxiliary_mark + auxiliary;
}

void add_numbers(const auto& words, std::vector<Span>& numbers) {
  for (const auto& word : words)
    if (word) numbers.push_back(word->number);
  std::sort(numbers.begin(), numbers.end(), is_before);
}

}  // namespace

std::vector<Span> target_numbers(const Move& move) {
  std::vector<Span> numbers;
  add_numbers(move.words, numbers);
  if (move.orientation) add_numbers(move.orientation->words, numbers);
  return numbers;
}

std::vector<Span> auxiliary_numbers(const Move& move) {
  std::vector<Span> numbers;
  if (move.arc) add_numbers(move.arc->centre_words, numbers);
  return numbers;
}

std::string_view statement_without_comment(const Program& program, const Move& move,
                                           std::string_view comment_mark) {
  const std::string_view block = part(program.text, move.block);
  bool quoted = false;
  for (std::size_t at = 0; at < block.size(); ++at) {
    if (block[at] == '"') quoted = !quoted;
    if (!quoted && block.substr(at).starts_with(comment_mark)) return block.substr(0, at);
  }
  return block;
}

std::string without_spaces(std::string_view text) {
  std::string rest(text);
  std::erase_if(rest, [](char c) { return is_one_of(c, " \t\r\n"); });
  return rest;
}

std::string words_without(std::string_view text, Span within, const std::vector<Span>& spans) {
  std::string rest;
  std::size_t at = within.begin;
  for (const Span& span : spans) {
    if (span.begin < at || span.end > within.end) continue;
    rest += without_spaces(text.substr(at, span.begin - at));
    at = span.end;
  }
  return rest + without_spaces(text.substr(at, within.end - at));
}

std::string target_kept_words(std::string_view text, Span within, const std::vector<Span>& numbers,
                              const StatementForm& form) {
  std::vector<Span> spans = numbers;
  if (form.has_named_numbers)
    for (Span& number : spans) {
      if (!is_within(number, within)) continue;
      while (number.begin > within.begin && is_one_of(text[number.begin - 1], " \t")) --number.begin;
      while (number.begin > within.begin && is_letter(text[number.begin - 1])) --number.begin;
    }
  std::string words = words_without(text, within, spans);
  return form.may_lack_numbers ? without_empty_places(words) : words;
}

std::string statement_kept_words(const Program& program, const Move& move, const StatementForm& form) {
  const std::string_view text = program.text;
  const std::string_view code = statement_without_comment(program, move, form.comment_mark);
  const Span statement{move.block.begin, move.block.begin + code.size()};
  std::vector<Span> numbers = target_numbers(move);
  for (const Span& number : auxiliary_numbers(move)) numbers.push_back(number);
  std::sort(numbers.begin(), numbers.end(), is_before);
  std::vector<NamedTarget> targets = named_targets(text, statement, numbers, form);
  if (form.replaced) targets.push_back({*form.replaced, std::string(form.replacement)});
  numbers.insert(numbers.end(), form.ignored.begin(), form.ignored.end());
  if (move.zone) numbers.push_back(move.zone->words);
  std::sort(numbers.begin(), numbers.end(), is_before);
  std::string words;
  std::size_t at = statement.begin;
  for (const NamedTarget& target : targets) {
    words += target_kept_words(text, {at, target.name.begin}, numbers, form) + target.words;
    at = target.name.end;
  }
  words += target_kept_words(text, {at, statement.end}, numbers, form);
  if (form.has_named_numbers) words = without_index(std::move(words));
  return move.arc ? as_line(std::move(words)) : words;
}

}  // namespace counterflex
