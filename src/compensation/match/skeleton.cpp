#include "compensation/match/skeleton.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "counterflex/program/read_program.hpp"

namespace counterflex {
namespace {

char upper(char c) {
  return static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Whether it is a word of one axis: a polar word gives two.
bool is_height(const Move& move, const PackedAxisWord& word) {
  std::size_t axes = 0;
  for (const auto& other : move.words) axes += word && other && other->number.begin == word->number.begin;
  return axes == 1;
}

std::vector<Span> rewritten_numbers(const Move& move) {
  std::vector<Span> numbers;
  const auto add = [&](const PackedAxisWord& word) {
    // A block may also have words of one before it: the centre or the surface that it uses.
    if (word && word->number.begin >= move.block.begin) numbers.push_back(word->number);
  };
  for (std::size_t axis = 0; axis < (move.called ? 2 : 3); ++axis)
    if (!move.polar || is_height(move, move.words[axis])) add(move.words[axis]);
  if (move.called && move.called->modal.empty())
    for (const auto& height : move.called->heights) add(height);
  if (move.orientation)
    for (const auto& word : move.orientation->words) add(word);
  if (move.arc) {
    for (const auto& word : move.arc->centre_words) add(word);
    add(move.arc->radius_word);
  }
  if (move.cycle) {
    add(move.cycle->bottom_word);
    add(move.cycle->retract_word);
  }
  std::sort(numbers.begin(), numbers.end(), [](Span a, Span b) { return a.begin < b.begin; });
  return numbers;
}

void drop_name(std::string& text) {
  while (!text.empty() && std::isalpha(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
}

// Takes the letter off with which a word begins, or its name and sign of equality, with the AC( or IC( of
// Sinumerik. True where a bracket has been taken off.
bool drop_letter(std::string& text, bool klartext) {
  if (text.empty()) return false;
  const bool bracket = text.back() == '(';
  if (bracket) text.pop_back(), drop_name(text);
  const bool named = !text.empty() && text.back() == '=';
  if (!text.empty()) text.pop_back();
  if (klartext && !text.empty() && upper(text.back()) == 'I') text.pop_back();
  if (named) drop_name(text);
  return bracket;
}

// The end of a word of motion (G0 to G3, with zeros before the digit) at `i`; `i` if it is missing.
std::size_t motion_word_end(const std::string& text, std::size_t i) {
  if (upper(text[i]) != 'G') return i;
  std::size_t end = i + 1;
  while (end + 1 < text.size() && text[end] == '0' && is_digit(text[end + 1])) ++end;
  if (end >= text.size() || text[end] < '0' || text[end] > '3') return i;
  const bool goes_on = end + 1 < text.size() && (is_digit(text[end + 1]) || text[end + 1] == '.');
  return goes_on ? i : end + 1;
}

// The end of a word of that letter or name at `i`; `i` if it is missing.
std::size_t word_end(const std::string& text, std::size_t i, std::string_view name) {
  for (std::size_t k = 0; k < name.size(); ++k)
    if (i + k >= text.size() || upper(text[i + k]) != name[k]) return i;
  return std::min(text.find_first_not_of("0123456789.", i + name.size()), text.size());
}

// Without words of motion, and without those that `names` gives.
std::string without_motion(const std::string& text, const std::vector<std::string_view>& names) {
  std::string kept;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == ';') return kept + text.substr(i);
    std::size_t end = text[i] == '(' ? std::min(text.find(')', i), text.size() - 1) + 1 : i;
    kept += text.substr(i, end - i);
    if (end > i) {
      i = end;
      continue;
    }
    end = motion_word_end(text, i);
    for (const std::string_view name : names)
      if (end == i) end = word_end(text, i, name);
    if (end == i) kept += text[end++];
    i = end;
  }
  return kept;
}

// Klartext: without the number of the block, which correction may move to another one.
std::string without_klartext_number(const std::string& text) {
  const std::size_t begin = !text.empty() && text[0] == '/' ? 1 : 0;
  std::size_t end = begin;
  if (end + 1 < text.size() && upper(text[end]) == 'N' && is_digit(text[end + 1])) ++end;
  while (end < text.size() && is_digit(text[end])) ++end;
  return text.substr(0, begin) + text.substr(end);
}

// Takes the word that begins with `key` out of `text` before `end`.
void drop_polar_word(std::string& text, std::string_view key, std::size_t end) {
  std::size_t begin = text.find(key);
  if (begin >= end) return;
  const std::size_t behind =
      std::min(text.find_first_not_of("+-0123456789.,", begin + key.size()), text.size());
  if (begin > 0 && text[begin - 1] == 'I') --begin;
  text.erase(begin, behind - begin);
}

// Klartext: without the words L, LP, C, CP, CR and CT at the beginning, the sense DR of an arc and what is
// left of polar coordinates.
std::string without_klartext_motion(std::string text) {
  const std::size_t begin = !text.empty() && text[0] == '/' ? 1 : 0;
  for (const std::string_view key : {"PA", "PR"})
    drop_polar_word(text, key, std::min(text.find(';'), text.size()));
  for (const std::string_view head : {"CR", "CT", "CP", "C", "LP", "L"})
    if (std::string_view(text).substr(begin).starts_with(head)) {
      text.erase(begin, head.size());
      break;
    }
  const std::size_t comment = std::min(text.find(';'), text.size()), sense = text.find("DR");
  if (sense < comment) text.erase(sense, std::min<std::size_t>(3, comment - sense));
  return text;
}

}  // namespace

namespace {

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

std::string without_blanks(std::string_view text) {
  std::string rest(text);
  std::erase_if(rest, [](char c) { return c == ' ' || c == '\t'; });
  return rest;
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
  const auto behind_blanks = [&](std::size_t at) {
    return std::min(statement.find_first_not_of(" \t", at), statement.size());
  };
  std::size_t head = 0;
  while (head < statement.size() && std::isalpha(static_cast<unsigned char>(statement[head])) != 0) ++head;
  if (head < statement.size() && statement[head] == '(') ++head;  // movel(start, a=1.2)
  std::size_t end = behind_target(statement, behind_blanks(head));
  if (const std::size_t comma = behind_blanks(end);
      has_arc && comma < statement.size() && statement[comma] == ',')
    end = behind_target(statement, behind_blanks(comma + 1));
  return std::string(statement.substr(0, head)) + '@' + without_zone(without_blanks(statement.substr(end)));
}

// Where the comment of the move's line begins, with the blanks before it: copies of the statement have none.
std::size_t statement_end(const Program& program, const Move& move) {
  std::string_view mark = ";";
  if (program.dialect == "abb") mark = "!";
  if (program.dialect == "ur") mark = "#";
  if (program.dialect == "apt") mark = "$$";
  if (program.dialect == "yaskawa") mark = "'";
  bool quoted = false;
  for (std::size_t at = move.block.begin; at < move.block.end; ++at) {
    if (program.text[at] == '"') quoted = !quoted;
    if (!quoted && program.text.compare(at, mark.size(), mark) == 0) return at;
  }
  return move.block.end;
}

// The length of "C", "BC", "EC" or "P" before the digits of a position of Yaskawa; 0 for other words.
std::size_t letters_of_position(std::string_view word) {
  for (const std::string_view letters : {"C", "BC", "EC", "P"})
    if (word.starts_with(letters) && word.size() > letters.size() &&
        word.find_first_not_of("0123456789", letters.size()) == std::string_view::npos)
      return letters.size();
  return 0;
}

// Yaskawa: '@' for the target, which may be another position in the corrected program. Names of base axes and
// stations, and of targets of moves that are not followed, lose their numbers, which insertion changes. CR is
// a zone.
std::string yaskawa_skeleton(std::string_view statement, bool is_followed) {
  std::string text;
  for (std::size_t at = 0; at < statement.size();) {
    const std::size_t end = std::min(statement.find_first_of(" \t", at), statement.size());
    const std::string_view word = statement.substr(at, end - at);
    at = end + 1;
    const std::size_t letters = letters_of_position(word);
    const bool is_target = letters == 1 && is_followed;
    if (word.starts_with("CR=")) continue;
    if (is_target)
      text += '@';
    else if (letters > 0 && word[0] != 'P')
      text.append(word.substr(0, letters)).append("@");
    else
      text.append(word);
  }
  return text;
}

// FANUC: the statement without the numbers of its lines and of its positions. A 'C' that became a line has
// one position.
std::string tp_statement(std::string_view block) {
  std::string text;
  for (std::size_t at = 0; at < block.size();) {
    const std::size_t end = std::min(block.find('\n', at), block.size());
    std::string_view line = block.substr(at, end - at);
    if (const std::size_t colon = line.find(':'); colon != std::string_view::npos)
      line.remove_prefix(colon + 1);
    text += without_blanks(line);
    at = end + 1;
  }
  std::erase(text, '\r');
  for (std::size_t at = 0; (at = text.find("P[", at)) != std::string::npos; at += 2) {
    const std::size_t close = std::min(text.find(']', at), text.size());
    text.erase(at + 2, close - at - 2);
  }
  constexpr std::string_view two = "CP[]P[]";
  if (text.starts_with(two)) text.replace(0, two.size(), "LP[]");
  return text;
}

// FANUC: the statement, and what its positions have besides the numbers that a correction changes.
std::string tp_skeleton(const Program& program, const Move& move) {
  std::vector<Span> numbers;
  const auto add = [&](const PackedAxisWord& word) {
    if (word) numbers.push_back(word->number);
  };
  for (const auto& word : move.words) add(word);
  if (move.orientation)
    for (const auto& word : move.orientation->words) add(word);
  const std::string& all = program.text;
  std::string text =
      tp_statement(std::string_view(all).substr(move.block.begin, move.block.end - move.block.begin));
  std::sort(numbers.begin(), numbers.end(), [](Span a, Span b) { return a.begin < b.begin; });
  if (numbers.empty()) return text;
  std::size_t at = all.rfind('{', numbers.front().begin);
  if (at == std::string::npos) at = numbers.front().begin;
  const auto keep = [&](std::size_t end) {
    for (; at < end; ++at)
      if (std::string_view(" \t\r\n").find(all[at]) == std::string_view::npos) text += all[at];
  };
  for (const Span& number : numbers) {
    keep(number.begin);
    at = number.end;
  }
  keep(std::min(all.find('}', at), all.size()));
  return text;
}

std::string robot_skeleton(const Program& program, const Move& move) {
  if (program.dialect == "fanuc_tp") return tp_skeleton(program, move);
  std::vector<Span> numbers;
  bool is_named = false;
  const auto add = [&](const PackedAxisWord& word) {
    if (!word) return;
    numbers.push_back(word->number);
    is_named = is_named || word->number.begin < move.block.begin || word->number.end > move.block.end;
  };
  for (const auto& word : move.words) add(word);
  if (move.orientation)
    for (const auto& word : move.orientation->words) add(word);
  if (move.arc)
    for (const auto& word : move.arc->centre_words) add(word);
  const std::size_t end = statement_end(program, move);
  const std::string_view statement =
      std::string_view(program.text).substr(move.block.begin, end - move.block.begin);
  if (program.dialect == "yaskawa") return yaskawa_skeleton(statement, is_named);
  if (is_named)
    return without_targets(statement.substr(std::min(statement.find_first_not_of(" \t"), statement.size())),
                           move.arc.has_value());
  std::sort(numbers.begin(), numbers.end(), [](Span a, Span b) { return a.begin < b.begin; });
  std::string text;
  std::size_t at = move.block.begin;
  for (const Span& number : numbers) {
    if (number.begin < at) continue;
    text.append(program.text, at, number.begin - at);
    at = number.end;
  }
  if (end > at) text.append(program.text, at, end - at);
  return without_index(without_zone(without_blanks(text)));
}

}  // namespace

bool are_alike(const std::string& a, const std::string& b) {
  const std::size_t named = a.find('@');
  if (named == std::string::npos && b.find('@') != std::string::npos) return are_alike(b, a);
  if (named == std::string::npos || a == b) return a == b;
  // The other has its numbers in the statement: between the same words is at least one bracket.
  const std::string_view head = std::string_view(a).substr(0, named),
                         tail = std::string_view(a).substr(named + 1);
  if (b.size() < a.size() || !b.starts_with(head) || !b.ends_with(tail)) return false;
  std::string_view target = std::string_view(b).substr(named, b.size() - head.size() - tail.size());
  if (target.starts_with('p')) target.remove_prefix(1);  // p[0.1, 0.2, ...]
  return (target.starts_with('{') && target.ends_with('}')) ||
         (target.starts_with('[') && target.ends_with(']'));
}

std::string skeleton(const Program& program, const Move& move) {
  if (is_robot_dialect(program.dialect)) return robot_skeleton(program, move);
  const bool klartext = program.dialect == "heidenhain";
  std::string text;
  std::size_t at = move.block.begin;
  const auto keep = [&](std::size_t end) {
    for (; at < end; ++at)
      if (program.text[at] != ' ' && program.text[at] != '\t') text += program.text[at];
  };
  for (const Span& number : rewritten_numbers(move)) {
    keep(number.begin);
    const bool bracket = drop_letter(text, klartext);
    at = number.end;
    if (bracket) at = program.text.find(')', at) + 1;
  }
  keep(move.block.end);
  std::vector<std::string_view> names{"N"};
  if (move.feed_mode == FeedMode::inverse_time) names.push_back("F");
  if (move.arc) names.insert(names.end(), {"P", "TURN="});
  if (klartext) return without_klartext_motion(without_klartext_number(text));
  return without_motion(text, names);
}

bool is_plain(const std::string& skeleton) {
  for (std::size_t i = 0; i < skeleton.size() && skeleton[i] != ';'; ++i) {
    const char c = upper(skeleton[i]);
    if (c == '(') i = std::min(skeleton.find(')', i), skeleton.size() - 1);
    if (c >= 'A' && c <= 'Z' && c != 'F') return false;
    if (c == 'F' && skeleton.compare(i, 4, "FMAX") == 0) i += 3;
  }
  return true;
}

}  // namespace counterflex
