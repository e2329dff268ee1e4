#include "program/sorted_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace counterflex {

const FoundG* SortedBlock::find(Action action) const {
  for (const FoundG& found : g)
    if (found.code->action == action) return &found;
  return nullptr;
}

bool SortedBlock::has(MAction action) const {
  return std::any_of(m.begin(), m.end(), [&](const FoundM& found) { return found.action == action; });
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
  bool has_m(std::initializer_list<int> codes) const {
    return std::any_of(sorted.m.begin(), sorted.m.end(), [&](const FoundM& found) {
      return std::find(codes.begin(), codes.end(), found.code) != codes.end();
    });
  }
};

void add_g(const Sorter& s, const Word& word) {
  const double tenths = word.value * 10;
  const bool fits = tenths >= 0 && tenths < 10000 && std::abs(tenths - std::round(tenths)) < 1e-6;
  const GCode* code = fits ? find_g_code(static_cast<int>(std::lround(tenths)), s.dialect) : nullptr;
  if (code == nullptr)
    s.fail(word, fmt::format("G{} is not known in dialect {}", word.value, s.dialect.name));
  if (code->action == Action::not_read) s.fail(word, fmt::format("G{}: {}", word.value, code->what));
  for (const FoundG& other : s.sorted.g)
    if (code->group != Group::none && other.code->group == code->group)
      s.fail(word, fmt::format("G{} and G{} exclude each other in one block", other.word->value, word.value));
  s.sorted.g.push_back({code, &word});
}

void add_m(const Sorter& s, const Word& word) {
  if (word.value < 0 || word.value > 9999 || word.value != std::floor(word.value))
    s.fail(word, fmt::format("M{} is not a code: whole numbers from 0 to 9999 are", word.value));
  const int code = static_cast<int>(word.value);
  const MAction action = action_of_m(code, s.dialect);
  if (action == MAction::not_read)
    s.fail(word,
           fmt::format("M{}: subprograms, saved states and switched kinematics are not read yet", code));
  s.sorted.m.push_back({action, code, &word});
}

void add_letter(const Sorter& s, const Word& word) {
  const Word*& slot = s.sorted.letters[static_cast<std::size_t>(word.letter - 'A')];
  if (slot != nullptr) s.fail(word, fmt::format("{} stands twice in the block", word.letter));
  slot = &word;
}

void check_number(const Sorter& s) {
  const Word* n = s.sorted.word('N');
  if (n == nullptr) return;
  if (n != s.block.words.data()) s.fail(*n, "N must be the first word of its block");
  if (n->value < 0) s.fail(*n, fmt::format("N{} is negative", n->value));
}

void check_rotary(const Sorter& s) {
  for (const char letter : {'A', 'B', 'C'})
    if (const Word* word = s.sorted.word(letter); word != nullptr && word->value != 0)
      s.fail(*word, fmt::format("{}{}: rotary axes other than at 0 are not read yet", letter, word->value));
}

void check_signs(const Sorter& s) {
  for (const char letter : {'F', 'S'})
    if (const Word* word = s.sorted.word(letter); word != nullptr && word->value < 0)
      s.fail(*word, fmt::format("{}{} is negative", letter, word->value));
  const Word* t = s.sorted.word('T');
  if (t != nullptr && (t->value < 0 || t->value != std::floor(t->value)))
    s.fail(*t, fmt::format("T{} is not a tool: whole numbers from 0 are", t->value));
}

bool has_tenths(const SortedBlock& block, int tenths) {
  return std::any_of(block.g.begin(), block.g.end(),
                     [&](const FoundG& g) { return g.code->tenths == tenths; });
}

/// Whether something in the block uses the word `letter`, which means nothing by itself.
bool is_used(const Sorter& s, char letter) {
  const SortedBlock& b = s.sorted;
  switch (letter) {
    case 'P':
      return b.has(Action::dwell) || b.has(Action::blend) || b.has(Action::reference_move) ||
             b.has(Action::smooth) || has_tenths(b, 80) || s.has_m({19, 50, 51, 52, 53, 62, 63, 64, 65, 66});
    case 'Q':
      return b.has(Action::blend) || b.has(Action::smooth) || s.has_m({19, 66, 67, 68});
    case 'R':
      return b.has(Action::smooth) || s.has_m({19});
    case 'L':
      return s.has_m({66});
    case 'E':
      return s.has_m({66, 67, 68}) || b.has(Action::smooth);
    case 'U':
      return b.has(Action::dwell) && s.dialect.dwell_takes_axis_words;
    case 'H':
      return b.has(Action::tool_length) || s.dialect.h_and_d_stand_alone;
    case 'D':
      return s.dialect.h_and_d_stand_alone;
    default:
      return std::string_view("ABCFNOSTXYZ").find(letter) != std::string_view::npos;
  }
}

void check_used(const Sorter& s, const Word& word) {
  if (is_used(s, word.letter)) return;
  switch (word.letter) {
    case 'I':
    case 'J':
    case 'K':
    case 'R':
      s.fail(word, fmt::format("{} belongs to arcs and cycles, and this block has neither", word.letter));
    case 'U':
    case 'V':
    case 'W':
      s.fail(word, fmt::format("{}: axes other than X, Y and Z are not read yet", word.letter));
    default:
      s.fail(word, fmt::format("{} has no code in its block that uses it", word.letter));
  }
}

}  // namespace

void sort_words(const std::string& file, const Dialect& dialect, const Block& block, SortedBlock& sorted) {
  sorted.letters.fill(nullptr);
  sorted.g.clear();
  sorted.m.clear();
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
  check_rotary(s);
  check_signs(s);
  for (const Word& word : block.words)
    if (word.letter != 'G' && word.letter != 'M') check_used(s, word);
}

}  // namespace counterflex
