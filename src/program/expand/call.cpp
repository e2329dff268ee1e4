#include "program/expand/call.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "program/gcode/words/codes.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr double largest_count = 1e9;

/// -1 if it is not a plain integer.
long whole(const Word& word) {
  if (!word.literal || word.value < 0 || word.value > largest_count || word.value != std::floor(word.value))
    return -1;
  return static_cast<long>(word.value);
}

/// Codes whose blocks do not use P and L for themselves.
bool may_be_beside(const Word& word, const Dialect& dialect) {
  constexpr std::array actions{Action::rapid,
                               Action::feed,
                               Action::arc,
                               Action::plane,
                               Action::absolute,
                               Action::relative,
                               Action::inches,
                               Action::millimetres,
                               Action::feed_per_minute,
                               Action::feed_per_turn,
                               Action::inverse_time,
                               Action::cutter,
                               Action::no_cutter,
                               Action::tool_length,
                               Action::no_tool_length,
                               Action::absolute_centres,
                               Action::relative_centres};
  if (!word.literal) return false;
  if (word.letter == 'M') {
    const MAction action = action_of_m(static_cast<int>(count_of(word)), dialect);
    return action == MAction::state || action == MAction::acts_after;
  }
  if (word.letter != 'G')
    return std::string_view("NXYZFSTHDIJKR").find(word.letter) != std::string_view::npos;
  const int tenths = static_cast<int>(std::lround(word.value * 10));
  const GCode* code = find_g_code(tenths, dialect);
  if (code == nullptr) return false;
  if (code->action == Action::work_offset) return tenths >= 540 && tenths <= 590;
  return std::find(actions.begin(), actions.end(), code->action) != actions.end();
}

bool counts(const Word& word, const Dialect& dialect) {
  return word.letter == 'L' || (word.letter == 'Q' && dialect.family == mach3_family);
}

std::string check_words(const Block& block, const Dialect& dialect, const SubprogramCall& call) {
  if (!empty(block.block_delete)) return "'/' may skip it";
  if (block.assigns) return "its block sets a variable";
  for (const Word& word : block.words) {
    const bool of_call = word.letter == 'P' || counts(word, dialect) || word.span.begin == call.span.begin;
    if (!of_call && (dialect.o_words ? word.letter != 'N' : !may_be_beside(word, dialect)))
      return fmt::format("its block has the word {}", word.letter);
  }
  return {};
}

/// P and the count of repeats.
void read_numbers(const Block& block, const Dialect& dialect, SubprogramCall& call) {
  const Word *p = nullptr, *count = nullptr;
  for (const Word& word : block.words) {
    if (word.letter != 'P' && !counts(word, dialect)) continue;
    const Word*& known = word.letter == 'P' ? p : count;
    if (known != nullptr) call.why_not = fmt::format("{} occurs twice", word.letter);
    known = &word;
    call.dropped.push_back(word.span);
  }
  if (p == nullptr) call.why_not = "it has no P";
  if (!call.why_not.empty()) return;
  const long number = whole(*p);
  if (count != nullptr) call.repeats = whole(*count);
  if (number < 0) call.why_not = "its P is not a plain number";
  if (call.repeats < 1) call.why_not = fmt::format("its {} is not an integer from 1", count->letter);
  call.name.name = fmt::format("{}", number);
  if (count != nullptr || dialect.family != fanuc_family || number <= 9999) return;
  call.other_reading = {call.name.kind, fmt::format("{}", number % 10000)};
  call.other_repeats = number / 10000;
}

SubprogramCall call_by_number(const Word& m, NameKind kind, const Block& block, const Dialect& dialect) {
  SubprogramCall call;
  call.name.kind = kind;
  call.span = m.span;
  call.dropped.push_back(m.span);
  call.why_not = check_words(block, dialect, call);
  read_numbers(block, dialect, call);
  return call;
}

/// Splits "[1.5] [#2*[3-1]]" into "1.5" and "#2*[3-1]"; false for other text.
bool read_arguments(std::string_view text, SubprogramCall& call) {
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    if (text.empty()) return true;
    int depth = 0;
    std::size_t close = 0;
    for (; close < text.size(); ++close) {
      if (text[close] == '[') ++depth;
      if (text[close] == ']' && --depth == 0) break;
    }
    if (text.front() != '[' || close == text.size()) return false;
    call.arguments.emplace_back(text.substr(1, close - 1));
    text.remove_prefix(close + 1);
  }
}

/// Position of the O of an O-word.
std::size_t letter_before(std::string_view text, std::size_t at) {
  while (at > 0 && upper(text[at]) != 'O') --at;
  return at;
}

SubprogramCall call_by_word(std::string_view text, const Block& block) {
  SubprogramCall call;
  call.name = {NameKind::word, normal_name(part(text, block.flow_name))};
  std::size_t end = block.flow_keyword.end;
  while (end < block.span.end && text[end] != comment_open && text[end] != ';') ++end;
  call.span = {letter_before(text, block.flow_name.begin - 1), end};
  call.dropped.push_back(call.span);
  if (!empty(block.block_delete)) call.why_not = "'/' may skip it";
  if (!block.comments.empty() && block.comments[0].begin < call.span.begin)
    call.why_not = "a comment is before it";
  if (call.name.name.empty()) call.why_not = "its name is a variable or an expression";
  if (!read_arguments(text.substr(block.flow_keyword.end, end - block.flow_keyword.end), call))
    call.why_not = "its arguments are not in brackets";
  return call;
}

}  // namespace

std::optional<SubprogramCall> call_in(std::string_view text, const Dialect& dialect, const Block& block) {
  if (is_word(part(text, block.flow_keyword), "CALL") && dialect.o_words) return call_by_word(text, block);
  if (const Word* m = find_m(block, 98)) return call_by_number(*m, NameKind::program, block, dialect);
  const bool local = (dialect.family & shop_families) != 0;
  const Word* m = local ? find_m(block, 97) : nullptr;
  if (m == nullptr) return std::nullopt;
  return call_by_number(*m, NameKind::block, block, dialect);
}

bool may_call(const Block& block, const Dialect& dialect) {
  return std::any_of(block.words.begin(), block.words.end(), [&](const Word& word) {
    if (word.letter != 'G' && word.letter != 'M') return false;
    if (!word.literal) return true;
    if (word.letter == 'M')
      return word.value >= 96 && action_of_m(static_cast<int>(count_of(word)), dialect) == MAction::call;
    const GCode* code =
        word.value < 1000 ? find_g_code(static_cast<int>(std::lround(word.value * 10)), dialect) : nullptr;
    return code != nullptr &&
           (code->action == Action::call || code->bit == modal_macro || code->action == Action::own_way);
  });
}

std::string why_never_replaced(const Block& block, const Dialect& dialect) {
  for (const Word& word : block.words) {
    if (word.letter != 'G' || !word.literal || word.value != 65) continue;
    const GCode* code = find_g_code(650, dialect);
    if (code != nullptr && code->action == Action::call) return "G65 passes arguments to a macro";
  }
  const bool calls_other = find_m(block, 198) != nullptr && action_of_m(198, dialect) == MAction::call;
  return calls_other ? "M198 calls a program outside of this file" : "";
}

}  // namespace counterflex
