#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "counterflex/files/input_error.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/machine/read_machine.hpp"

namespace counterflex {
namespace {

constexpr std::string_view word_letters = "TPDXYZABCUVWIJQ";
constexpr double largest_tool = 99999999;

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

/// One line of the table.
class ToolLine {
 public:
  ToolLine(std::string_view text, const std::string& file, int line) : text_(text), file_(file), line_(line) {
    text_ = text_.substr(0, text_.find(';'));
  }

  void read() {
    for (std::size_t at = 0; at < text_.size();) {
      if (is_blank(text_[at])) {
        ++at;
        continue;
      }
      std::size_t end = at;
      while (end < text_.size() && !is_blank(text_[end])) ++end;
      read_word(at, text_.substr(at, end - at));
      at = end;
    }
    if (any_ && !tool) fail(0, "the line has no tool; each line begins with T and its number");
  }

  [[noreturn]] void fail(std::size_t at, const std::string& message) const {
    throw InputError(ErrorKind::machine_or_force, {file_, line_, static_cast<int>(at) + 1}, message);
  }

  std::optional<long> tool;
  double length_mm = 0;

 private:
  void read_word(std::size_t at, std::string_view word) {
    const char letter = word[0] >= 'a' && word[0] <= 'z' ? static_cast<char>(word[0] - 'a' + 'A') : word[0];
    const auto value = read_number(word.substr(1));
    any_ = true;
    if (word_letters.find(letter) == std::string_view::npos || !value)
      fail(at,
           fmt::format("'{}' is not a word of a tool table; allowed are T, P, D, X, Y, Z, A, B, C, U, V, W, "
                       "I, J and Q with a number, and comments after ';'",
                       word));
    if (read_.find(letter) != std::string::npos)
      fail(at, fmt::format("'{}' gives {} a second time; give each word once in a line", word, letter));
    read_ += letter;
    if (letter == 'Z') length_mm = *value;
    if (letter != 'T') return;
    if (*value < 0 || *value > largest_tool || *value != std::floor(*value))
      fail(at, fmt::format("the tool is '{}', must be a whole number of at least 0", word));
    tool = static_cast<long>(*value);
  }

  std::string_view text_;
  const std::string& file_;
  int line_;
  bool any_ = false;
  std::string read_;  // letters of the words before
};

}  // namespace

std::map<long, double> read_tool_table(std::string_view text, const std::string& file) {
  std::map<long, double> lengths;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    ToolLine line(text.substr(0, end), file, number);
    line.read();
    if (line.tool && !lengths.emplace(*line.tool, line.length_mm * mm).second)
      line.fail(0, fmt::format("tool {} is defined twice", *line.tool));
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  return lengths;
}

}  // namespace counterflex
