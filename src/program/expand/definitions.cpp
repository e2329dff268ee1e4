#include "program/expand/definitions.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// The first letter of a line, behind blanks and the N of an O line; 'O' for the ':' of ":1000"; 0 if the
/// line begins with another character.
char first_letter(std::string_view line) {
  std::size_t at = 0;
  const auto skip = [&](auto of_kind) {
    while (at < line.size() && of_kind(line[at])) ++at;
  };
  skip(is_blank);
  if (at + 1 < line.size() && upper(line[at]) == 'N' && is_digit(line[at + 1])) {
    ++at;
    skip(is_digit);
    skip(is_blank);
    if (at == line.size() || upper(line[at]) != 'O') return 'N';
  }
  if (at == line.size()) return '\0';
  return line[at] == ':' ? 'O' : upper(line[at]);
}

std::string number_text(const Word& word) {
  return word.literal ? fmt::format("{}", count_of(word)) : std::string();
}

/// Finds the lines of a text at which subprograms may begin.
class Finder {
 public:
  Finder(std::string_view text, const std::string& file, const Dialect& dialect)
      : text_(text),
        file_(file),
        dialect_(dialect),
        blocks_are_called_(text.find("M97") != std::string_view::npos ||
                           text.find("m97") != std::string_view::npos) {}

  Definitions run() {
    Block block;
    while (next_line(text_, block)) {
      const std::string_view line = part(text_, block.span);
      const char first = first_letter(line);
      if (first == '%') {
        if (has_words_) break;
        has_words_ = true;
      }
      has_words_ = has_words_ || (first != '\0' && first != comment_open && first != ';');
      if (first == 'O' || first == 'N' || !ended_) note(block);
    }
    return std::move(found_);
  }

 private:
  void note(Block& block) {
    if (!lexes(text_, file_, dialect_, block)) return;
    const LinePlace place{block.span.begin, block.line};
    if (is_word(part(text_, block.flow_keyword), "SUB") && empty(block.block_delete))
      add({NameKind::word, normal_name(part(text_, block.flow_name))}, place);
    for (const Word& word : block.words) {
      if (word.letter == 'O' && (!dialect_.o_words || ended_))
        add({NameKind::program, number_text(word)}, place);
      if (word.letter == 'N' && blocks_are_called_) add({NameKind::block, number_text(word)}, place);
    }
    ended_ = ended_ || (ends_program(block) && empty(block.block_delete));
  }

  void add(SubprogramName name, LinePlace place) {
    if (!name.name.empty()) found_[std::move(name)].push_back(place);
  }

  std::string_view text_;
  const std::string& file_;
  const Dialect& dialect_;
  const bool blocks_are_called_;
  bool has_words_ = false, ended_ = false;
  Definitions found_;
};

void end_at(const Block& block, Definition& d) {
  d.ends = true;
  d.end = {block.span.begin, block.line};
  d.after = {block.line_end.end, block.line + 1};
}

void forbid(Definition& d, std::string_view why) {
  if (d.why_not.empty()) d.why_not = why;
}

bool is_m(const Word& word, int code) {
  return word.letter == 'M' && word.literal && word.value == code;
}

/// Notes why a block of the body prevents copying it.
void look_at_words(const Block& block, bool by_word, const Dialect& dialect, Definition& d) {
  if (block.assigns && dialect.o_words && !by_word) forbid(d, "its body sets variables");
  for (const Word& word : block.words) {
    if (is_m(word, 73)) forbid(d, "M73 in its body restores modal states");
    if (word.literal) continue;
    if (word.letter == 'G' || word.letter == 'M')
      forbid(d, "a code in its body is a variable or an expression");
    if (dialect.o_words && !by_word) forbid(d, "its body has variables or expressions");
  }
}

/// Whether M99 ends the body here.
bool is_return(const Block& block, Definition& d) {
  if (find_m(block, 99) == nullptr) return false;
  if (!empty(block.block_delete)) {
    forbid(d, "'/' may skip the M99 in its body");
    return false;
  }
  if (find_letter(block, 'P') == nullptr) return true;
  forbid(d, "its M99 jumps to a block number");
  d.seeks_numbers = true;
  return true;
}

/// Whether a line of flow ends the body.
bool ends_sub(std::string_view text, const Block& block, const SubprogramName& name, Definition& d) {
  const std::string_view keyword = part(text, block.flow_keyword);
  if (name.kind == NameKind::word && is_word(keyword, "ENDSUB") &&
      normal_name(part(text, block.flow_name)) == name.name) {
    const std::string_view rest =
        text.substr(block.flow_keyword.end, block.span.end - block.flow_keyword.end);
    if (rest.substr(0, rest.find_first_of("(;")).find('[') != std::string_view::npos)
      forbid(d, "its endsub returns a value");
    return true;
  }
  if (is_word(keyword, "SUB") || is_word(keyword, "ENDSUB"))
    forbid(d, "another subprogram is defined in its body");
  return false;
}

void add_to_flow(std::string_view text, const Block& block, const Dialect& dialect,
                 const SubprogramName& name, Definition& d) {
  try {
    add_flow(text, dialect, block, true, d.flow);
  } catch (const UnknownFlow& unknown) {
    forbid(d, unknown.why);
  }
  // The variables of such a body are not known.
  if (dialect.o_words && name.kind != NameKind::word && !d.flow.lines.empty())
    forbid(d, "its body has a condition, a loop, a jump or a return");
}

void join_flow(Definition& d) {
  try {
    join_structures(d.flow);
  } catch (const UnknownFlow& unknown) {
    forbid(d, unknown.why);
  }
}

/// Reads the lines of the body, up to the line that ends it: with jumps, the last M99.
void read_body(std::string_view text, const std::string& file, const Dialect& dialect,
               const SubprogramName& name, Definition& d) {
  const bool by_word = name.kind == NameKind::word;
  Block block = before(d.body);
  while (next_line(text, block)) {
    if (!d.ends)
      lex(text, file, dialect, block);
    else if (!lexes(text, file, dialect, block))
      return;
    const bool other = block.percent || find_letter(block, 'O') != nullptr;
    if (other || (ends_program(block) && empty(block.block_delete))) return;
    if (!empty(block.flow_keyword) && ends_sub(text, block, name, d)) return end_at(block, d);
    add_to_flow(text, block, dialect, name, d);
    if (!empty(block.flow_keyword)) continue;
    look_at_words(block, by_word, dialect, d);
    if (by_word || !is_return(block, d)) continue;
    end_at(block, d);
    if (!has_jumps(d.flow)) return;
  }
}

}  // namespace

bool lexes(std::string_view text, const std::string& file, const Dialect& dialect, Block& block) {
  try {
    lex(text, file, dialect, block);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

Block before(LinePlace place) {
  Block block;
  block.line = block.text_line = place.line - 1;
  block.line_end = {place.at, place.at};
  return block;
}

const Word* find_m(const Block& block, int code) {
  const auto word =
      std::find_if(block.words.begin(), block.words.end(), [&](const Word& w) { return is_m(w, code); });
  return word == block.words.end() ? nullptr : &*word;
}

const Word* find_letter(const Block& block, char letter) {
  const auto word =
      std::find_if(block.words.begin(), block.words.end(), [&](const Word& w) { return w.letter == letter; });
  return word == block.words.end() ? nullptr : &*word;
}

bool ends_program(const Block& block) {
  return find_m(block, 2) != nullptr || find_m(block, 30) != nullptr;
}

std::string normal_name(std::string_view name) {
  std::string normal;
  for (const char c : name)
    if (!is_blank(c)) normal += lower(c);
  if (normal.empty() || normal[0] == '<') return normal;
  if (!is_digit(normal[0])) return {};
  const std::size_t digits = std::min(normal.find_first_not_of('0'), normal.size() - 1);
  return normal.substr(digits);
}

Definitions find_definitions(std::string_view text, const std::string& file, const Dialect& dialect) {
  return Finder(text, file, dialect).run();
}

Definition read_definition(std::string_view text, const std::string& file, const Dialect& dialect,
                           const SubprogramName& name, LinePlace begin) {
  Definition d;
  d.begin = d.body = begin;
  if (name.kind != NameKind::block) {
    Block block = before(begin);
    next_line(text, block);
    lex(text, file, dialect, block);
    const auto names = [](const Word& word) { return word.letter == 'O' || word.letter == 'N'; };
    if (!std::all_of(block.words.begin(), block.words.end(), names)) forbid(d, "its O line has other words");
    if (!empty(block.block_delete)) forbid(d, "'/' may skip its O");
    d.body = {block.line_end.end, block.line + 1};
  }
  read_body(text, file, dialect, name, d);
  join_flow(d);
  return d;
}

}  // namespace counterflex
