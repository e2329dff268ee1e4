#include "program/gcode/words/sorted_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/gcode/words/used_letters.hpp"

namespace counterflex {

bool SortedBlock::has_any(std::string_view wanted) const {
  return std::any_of(wanted.begin(), wanted.end(), [&](char letter) { return word(letter) != nullptr; });
}

const FoundG* SortedBlock::find(Action action) const {
  if (!has(action)) return nullptr;
  return &*std::find_if(g.begin(), g.end(),
                        [&](const FoundG& found) { return found.code->action == action; });
}

namespace {

struct Sorter {
  const std::string& file;
  const Dialect& dialect;
  const Block& block;
  SortedBlock& sorted;

  [[noreturn]] void fail(const Word& word, const std::string& message) const {
    refuse(file, block, word.span.begin, message);
  }
};

/// G70 and G71 without the size of a pattern of holes are units, as on older controls.
bool is_unit_code(const Sorter& s, int tenths) {
  const auto& words = s.block.words;
  return (tenths == 700 || tenths == 710) && s.dialect.macro_words &&
         std::none_of(words.begin(), words.end(), [](const Word& word) { return word.letter == 'I'; });
}

/// G100 with a tool is a tool change of Brother controls, which moves.
bool changes_tool(const Sorter& s, int tenths) {
  const auto& words = s.block.words;
  return tenths == 1000 && s.dialect.macro_words &&
         std::any_of(words.begin(), words.end(), [](const Word& word) { return word.letter == 'T'; });
}

/// G5 P10001 to P10999 of Fanuc run stored high-speed cycles, which move axes. Other numbers switch modes.
bool runs_stored_cycle(const Sorter& s, int tenths) {
  constexpr double high_precision = 10000;
  if (tenths != 50 || !s.dialect.macro_words) return false;
  const auto& words = s.block.words;
  const auto p =
      std::find_if(words.begin(), words.end(), [](const Word& word) { return word.letter == 'P'; });
  return p != words.end() && (!p->literal || p->value > high_precision);
}

constexpr GCode stored_cycle{50, Action::own_way};

const GCode* code_of(const Sorter& s, const Word& word) {
  const double tenths = word.value * 10;
  // A control with the code of an unsupported option knows its meaning.
  const GCode* const otherwise = s.dialect.macro_words ? &unknown_g_code() : nullptr;
  if (tenths < 0 || tenths > 10000) return nullptr;
  const int nearest = static_cast<int>(tenths + 0.5);
  if (std::abs(tenths - nearest) >= 1e-6) return nullptr;
  if (is_unit_code(s, nearest)) return find_g_code(nearest == 700 ? 200 : 210, s.dialect);
  if (changes_tool(s, nearest)) return &unknown_g_code();
  if (runs_stored_cycle(s, nearest)) return &stored_cycle;
  const GCode* const found = find_g_code(nearest, s.dialect);
  return found != nullptr ? found : otherwise;
}

void add_g(const Sorter& s, const Word& word) {
  if (!word.literal) {
    s.sorted.unknown_code = true;
    return;
  }
  const GCode* code = code_of(s, word);
  if (code == nullptr)
    s.fail(word, fmt::format("G{} is not known in dialect {}", word.value, s.dialect.name));
  if (code->action == Action::not_read) s.fail(word, fmt::format("G{}: {}", word.value, code->what));
  const auto same = [&](const FoundG& other) {
    return other.code == code && other.word->value == word.value;
  };
  if (s.dialect.macro_words && code->group != CodeGroup::none &&
      std::any_of(s.sorted.g.begin(), s.sorted.g.end(), same))
    return;  // occurs twice
  for (const FoundG& other : s.sorted.g)
    if (code->group != CodeGroup::none && other.code->group == code->group)
      s.fail(word, fmt::format("G{} and G{} exclude each other in one block", other.word->value, word.value));
  s.sorted.g.push_back({code, &word});
  s.sorted.actions |= std::uint64_t{1} << static_cast<unsigned>(code->action);
}

void add_m(const Sorter& s, const Word& word) {
  if (!word.literal) {
    s.sorted.unknown_code = true;
    return;
  }
  if (word.value < 0 || word.value > 99999 || word.value != std::floor(word.value))
    s.fail(word, fmt::format("M{} is not a code: expected an integer from 0 to 99999", word.value));
  const int code = static_cast<int>(word.value);
  const MAction action = action_of_m(code, s.dialect);
  s.sorted.m.push_back({action, code, &word});
  s.sorted.m_actions |= 1u << static_cast<unsigned>(action);
}

/// A macro call may have I, J and K several times.
void add_letter(const Sorter& s, const Word& word) {
  const bool again = s.sorted.word(word.letter) != nullptr;
  // Some controls get the next tool beside the one to change to.
  if (again && word.letter == 'T' && s.dialect.macro_words) return;
  if (again && !s.sorted.has(Action::call))
    s.fail(word, fmt::format("{} occurs twice in the block", word.letter));
  const auto i = static_cast<std::size_t>(word.letter - 'A');
  s.sorted.letters[i] = &word;
  s.sorted.present |= 1u << i;
}

void check_number(const Sorter& s) {
  const Word* n = s.sorted.word('N');
  if (n == nullptr) return;
  if (n != s.block.words.data() && !s.dialect.number_anywhere)
    s.fail(*n, "N must be the first word of its block");
  if (n->value < 0) s.fail(*n, fmt::format("N{} is negative", n->value));
}

/// G15 H1 and G56 H1 have another meaning on other controls.
void check_okuma(const Sorter& s) {
  const Word* h = s.sorted.word('H');
  if (h == nullptr) return;
  for (const FoundG& g : s.sorted.g)
    if (g.code->tenths == 150)
      s.fail(*g.word, "G15 with H selects a work offset on Okuma controls, whose programs are not supported");
}

void check_signs(const Sorter& s) {
  for (const char letter : {'F', 'S'})
    if (const Word* word = s.sorted.word(letter); word != nullptr && word->value < 0)
      s.fail(*word, fmt::format("{}{} is negative", letter, word->value));
  const Word* t = s.sorted.word('T');
  if (t != nullptr && (t->value < 0 || t->value != std::floor(t->value)))
    s.fail(*t, fmt::format("T{} is not a tool: expected an integer from 0", t->value));
}

[[noreturn]] void refuse_unused(const Sorter& s, const Word& word) {
  switch (word.letter) {
    case 'I':
    case 'J':
    case 'K':
    case 'R':
      s.fail(word, fmt::format("{} belongs to an arc or a cycle, but this block has neither", word.letter));
    default:
      s.fail(word, fmt::format("no code in the block uses {}", word.letter));
  }
}

void check_used(const Sorter& s, Context context) {
  if (s.sorted.unknown_code || context == Context::unknown) return;
  const Letters used = used_letters(s.sorted, s.dialect, context);
  for (const Word& word : s.block.words)
    if (word.letter != 'G' && word.letter != 'M' && (used & letter_bit(word.letter)) == 0)
      refuse_unused(s, word);
}

}  // namespace

void sort_words(const std::string& file, const Dialect& dialect, const Block& block, Context context,
                SortedBlock& sorted) {
  sorted.present = 0;
  sorted.g.clear();
  sorted.m.clear();
  sorted.actions = sorted.m_actions = 0;
  sorted.unknown_code = false;
  const Sorter s{file, dialect, block, sorted};
  for (const Word& word : block.words) {
    if (word.letter == 'G') {
      add_g(s, word);
    } else if (word.letter == 'M') {
      add_m(s, word);
    } else {
      add_letter(s, word);
    }
  }
  check_number(s);
  check_signs(s);
  check_okuma(s);
  check_used(s, context);
}

}  // namespace counterflex
