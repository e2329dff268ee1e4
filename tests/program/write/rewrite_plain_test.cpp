#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// Blocks of coordinates in many styles, and the targets of their moves.
class RandomEdits {
 public:
  explicit RandomEdits(std::uint64_t seed) : bits_(seed) {}

  std::vector<std::string> lines(int count) {
    std::vector<std::string> lines{chance(30) ? "G20 G90 G1 F9. X0.Y0.Z0." : "G21 G90 G1 F900. X0.Y0.Z0."};
    for (int i = 0; i < count; ++i) lines.push_back(line());
    return lines;
  }

  std::vector<MoveEdit> edits(const Program& program) {
    std::vector<MoveEdit> edits;
    for (const MoveEdit& same : edits_to_original(program)) {
      if (chance(5)) continue;
      edits.push_back(same);
      const double size = std::array{0.0, 1e-5, 1e-3, 0.2, 5.0}[bits_() % 5];
      for (double& value : edits.back().end_mm)
        value += size * (static_cast<double>(bits_() % 2001) / 1000 - 1);
      if (edits.back().centre_mm)
        *edits.back().centre_mm += edits.back().end_mm - program.moves[same.move].end_mm;
    }
    return edits;
  }

 private:
  bool chance(int percent) { return static_cast<int>(bits_() % 100) < percent; }

  std::string number() {
    constexpr std::array signs{"", "", "-", "-", "+"};
    constexpr std::array wholes{"0", "7", "12", "999", "007", "", "9999999"};
    constexpr std::array rests{".", ".5", ".25", ".0000", ".125", ".123456", ".9995", ".1234567890"};
    const std::string whole = wholes[bits_() % wholes.size()];
    return signs[bits_() % signs.size()] + whole + rests[whole.empty() ? 1 + bits_() % 7 : bits_() % 8];
  }

  std::string line() {
    if (chance(2)) return chance(50) ? "G91" : "G90";
    std::vector<std::string> words;
    for (const char axis : {'X', 'Y', 'Z'})
      if (chance(70)) words.push_back(axis + number());
    if (chance(10)) std::reverse(words.begin(), words.end());
    if (chance(20)) words.push_back("F50.");
    if (chance(4) && !words.empty()) words.push_back("G43 H1");
    std::string line = chance(3) ? "/" : chance(20) ? "N5" : chance(20) ? (chance(50) ? "G1" : "G0") : "";
    for (const std::string& word : words) line += (line.empty() || chance(30) ? "" : " ") + word;
    return words.empty() ? "G1" : line;
  }

  std::mt19937_64 bits_;
};

/// Long enough that no block with it is short.
const std::string long_comment = "(" + std::string(300, 'a') + ")";

std::string joined(const std::vector<std::string>& lines, const std::string& behind) {
  std::string text;
  for (const std::string& line : lines) text += line + behind + "\n";
  return text;
}

std::string without_comment(std::string text) {
  for (std::size_t at = 0; (at = text.find(long_comment, at)) != std::string::npos;)
    text.erase(at, long_comment.size());
  return text;
}

}  // namespace

TEST_CASE("a short line is rewritten as a long one, with all words and styles") {
  RandomEdits source(81);
  for (int i = 0; i < 3000; ++i) {
    const std::vector<std::string> lines = source.lines(12);
    ReadOptions options;
    options.dialect = i % 4 == 0 ? "haas" : "fanuc";
    const Program program = read_program(joined(lines, ""), "p.ngc", options);
    const Program beside = read_program(joined(lines, long_comment), "p.ngc", options);
    const std::vector<MoveEdit> edits = source.edits(program);
    const WriteOptions write{.decimals = i % 3 == 0 ? i % 11 : -1};
    const Rewritten plain = rewrite(program, edits, write), other = rewrite(beside, edits, write);
    CAPTURE(program.text);
    CHECK(plain.text == without_comment(other.text));
    CHECK(plain.changed_words == other.changed_words);
    CHECK(plain.inserted_words == other.inserted_words);
    CHECK(plain.blocks_of_edit == other.blocks_of_edit);
  }
}

TEST_CASE("a line whose new numbers exceed the control's limit is refused, a short one is not") {
  ReadOptions options;
  options.dialect = "linuxcnc";
  const std::string begin = "G21 G90 G1 F900 X0 Y0 Z0\n";
  for (const std::size_t length : {20, 200, 248, 249, 250, 255}) {
    CAPTURE(length);
    const Program program =
        read_program(begin + "X5" + std::string(length - 4, ' ') + "Y7\n", "p.ngc", options);
    std::vector<MoveEdit> edits = shifted(program, {0.125, 0.125, 0});
    const bool fits = length + 2 * std::string(".125").size() <= 255;
    CHECK((diagnostic_of([&] { rewrite(program, edits, {}); }) == "none") == fits);
  }
}
