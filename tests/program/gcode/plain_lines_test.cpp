#include <doctest/doctest.h>
#include <fmt/format.h>

#include <map>
#include <random>

#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// Random lines of common words in any state, sometimes with uncommon or invalid words.
class RandomLines {
 public:
  explicit RandomLines(std::uint64_t seed) : bits_(seed) {}

  std::vector<std::string> program(int lines, bool siemens) {
    siemens_ = siemens;
    std::vector<std::string> program{siemens ? "G71 G90 G1 F900 X0 Y0 Z0" : "G21 G90 G1 F900 X0 Y0 Z0"};
    for (int i = 0; i < below(4); ++i) program.push_back(state());
    for (int i = 0; i < lines; ++i) program.push_back(chance(3) ? state() : line());
    return program;
  }

 private:
  int below(int n) { return static_cast<int>(bits_() % static_cast<std::uint64_t>(n)); }
  bool chance(int percent) { return below(100) < percent; }
  std::string any(std::initializer_list<const char*> list) {
    return list.begin()[below(static_cast<int>(list.size()))];
  }

  std::string state() {
    if (siemens_ && chance(80))
      return any({"TRANS X5",   "TRANS",
                  "ATRANS Z1",  "G500",
                  "G54",        "MCALL CYCLE81(5,0,1,-5)",
                  "MCALL",      "D1",
                  "D0",         "X=IC(5)",
                  "Y=AC(2)",    "G1 X=AC(5) Y3",
                  "R1=5",       "X=R1",
                  "ROT Z5",     "G2 X5 Y5 CR=900",
                  "T1",         "M6",
                  "G74 X1=0",   "MSG(\"X1 Y2\")",
                  "AA:",        "N5: X1",
                  "STOPRE",     "G60",
                  "G64",        "G70",
                  "G71",        "G91",
                  "G90",        "G93",
                  "G95",        "G0",
                  "F5",         "N8",
                  "SUPA G0 Z0", "G291"});
    return any({"G20",          "G21",     "G91",      "G90",  "G93",    "G94",          "G95",
                "G61.1",        "G64",     "G54",      "G55",  "G0",     "G2 I5",        "G80",
                "G81 Z-5 R2",   "M3 S900", "T2 M6",    "T5",   "G43 H1", "G49",          "G53 G0 Z0",
                "G28 X0",       "G92 X1",  "G92.1",    "A5",   "A0",     "G41 D1 X1 Y1", "G40 X9",
                "G52 X1 Y0 Z0", "/X5",     "/G91",     "F100", "G1 F50", "N7",           "(FORCE FX=5)",
                "(FORCE OFF)",  "(SLOT)",  "G96 S100", "",     " ",      "G9 X1",        "G4 P1",
                "#1=5",         "X#1"});
  }

  std::string number() {
    std::string text = any({"", "", "", "-", "-", "+"});
    text += any({"0", "5", "12", "999", "007", "", "104"});
    if (chance(80)) text += any({".", ".5", ".25", ".0000", ".125", ".123456"});
    if (chance(1))
      text += any({"e5", ".", " 5", " .5", "123456789012345", "1234567890123", "-1", "=", ",R1", "*"});
    return text;
  }

  std::string word() {
    if (chance(1))
      return any({"S500", "M8",  "A0", "A1",     "T2",     "I1",   "R2",  "G9",    "G53",  "G91", "G20",
                  "D1",   "/",   "%",  "O5",     "G2",     "G1.0", "G-1", "G0001", "N1.5", "N-5", "N3",
                  "F-5",  "F-0", "X",  "Z[1+2]", "(note)", ";",    "Y 5", "\x7f",  "G4",   "X1"});
    const char letter = "XYZXYZFG"[below(8)];
    const char shown = chance(10) ? static_cast<char>(letter - 'A' + 'a') : letter;
    return shown + (letter == 'G'   ? any({"0", "1", "01", "00"})
                    : letter == 'F' ? any({"100", "50.5"})
                                    : number());
  }

  std::string line() {
    std::string line = chance(20) ? "N" + std::to_string(below(1000)) : chance(2) ? "\t " : "";
    const bool dense = chance(30);
    std::string used;
    for (int i = 0; i < 1 + below(4); ++i) {
      const std::string next = word();
      const char letter = static_cast<char>(next[0] & ~0x20);
      if (used.find(letter) != std::string::npos && !chance(1)) continue;
      used += letter;
      line += (dense ? "" : " ") + next;
    }
    return line + any({"", "", "", " ", "\t "});
  }

  std::mt19937_64 bits_;
  bool siemens_ = false;
};

/// The lines as a text, with `comment` behind all lines with words, so that no line is plain.
std::string lines_text(const std::vector<std::string>& lines, const std::string& comment,
                       const std::string& line_end) {
  std::string text;
  for (const std::string& line : lines) {
    const bool has_other_characters = line.find_first_of(";(%\x7f") != std::string::npos;
    const bool has_words = line.find_first_not_of(" \t") != std::string::npos && !has_other_characters;
    text += line + (has_words ? comment : "") + line_end;
  }
  return text;
}

std::string all_of(const Move& move, const PackedAxisWord& word) {
  if (!word) return "-";
  return fmt::format("{}+{}.{}", word->number.begin - move.block.begin, word->number.end - word->number.begin,
                     word->decimals);
}

std::string all_of(const std::array<bool, 3>& axes) {
  return fmt::format("{:d}{:d}{:d}", axes[0], axes[1], axes[2]);
}

std::string all_of(const Vector3& p) {
  return fmt::format("{:a} {:a} {:a}", p.x(), p.y(), p.z());
}

/// All members of a move except the end of its line; positions count from its block.
std::string all_of(const Program& program, const Move& move) {
  std::string text = fmt::format(
      "line {} {} group {} block {} number {} from {} to {} feed {:a} {:a} spindle {:a} offset {} tool {} of "
      "'{}'",
      move.line, move.text_line, move.group, move.block_index, move.block_number.value_or(-1),
      all_of(move.start_mm), all_of(move.end_mm), move.feed_mm_min, move.feed_per_min, move.spindle_rpm,
      move.frame, move.tool, program.operations[move.operation]);
  for (const PackedAxisWord& word : move.words) text += " " + all_of(move, word);
  for (const auto& axes :
       {move.moved_only_by_program, move.known_start, move.known_end, move.ignored, move.fixed})
    text += " " + all_of(axes);
  for (const int mode :
       {static_cast<int>(move.motion), static_cast<int>(move.unit), static_cast<int>(move.feed_mode),
        static_cast<int>(move.handling), int{move.relative}, int{move.block_delete}, int{move.exact_stop},
        int{move.may_split}, int{move.may_jump}, int{move.may_insert_words}, int{move.arc.has_value()},
        int{move.cycle.has_value()}, int{move.force.has_value()}})
    text += fmt::format(" {}", mode);
  if (move.force) text += fmt::format(" force {}", (*move.force)[0]);
  return text;
}

/// The result of reading the text, or the error.
std::vector<std::string> found_in(const std::string& text, const ReadOptions& options) {
  std::vector<std::string> found;
  const std::string complaint = diagnostic_of([&] {
    const Program program = read_program(text, "p.ngc", options);
    for (const Move& move : program.moves) found.push_back(all_of(program, move));
    for (const LeftAlone& block : program.left_alone)
      found.push_back(fmt::format("{}: {}", block.line, block.why));
    for (const Remark& remark : program.remarks)
      found.push_back(fmt::format("{}: {}", remark.line, remark.what));
    found.push_back(fmt::format("{} blocks", program.block_count));
  });
  found.push_back(complaint);
  return found;
}

}  // namespace

TEST_CASE(
    "a line of common words has the same meaning with a comment behind it, in every state and dialect") {
  RandomLines source(71);
  std::map<std::string, int> read_to_the_end;
  for (int i = 0; i < 6000; ++i) {
    ReadOptions options;
    options.dialect =
        std::array{"linuxcnc", "grbl", "fanuc", "haas", "mach3", "siemens"}[static_cast<std::size_t>(i % 6)];
    const bool siemens = options.dialect == "siemens";
    if (i % 7 == 0) options.integer_words = i % 2 == 0 ? IntegerWords::increments : IntegerWords::units;
    const std::vector<std::string> lines = source.program(10, siemens);
    const std::string line_end = i % 3 == 0 ? "\r\n" : "\n";
    const std::string text = lines_text(lines, "", line_end);
    CAPTURE(options.dialect);
    CAPTURE(text);
    const auto found = found_in(text, options);
    const auto other = found_in(lines_text(lines, siemens ? ";" : "()", line_end), options);
    for (std::size_t k = 0; k < std::min(found.size(), other.size()); ++k) CHECK(found[k] == other[k]);
    CHECK(found.size() == other.size());
    read_to_the_end[options.dialect] += found.back() == "none" ? 1 : 0;
  }
  for (const auto& [dialect, count] : read_to_the_end) {
    const auto& shown = dialect;
    CAPTURE(shown);
    CHECK(count > 250);
  }
}

TEST_CASE("a line with another line end, or without one, has the same meaning") {
  const std::string begin = "G21 G90 G0 X0 Y0 Z0\n";
  const auto moves = found_in(begin + "G1 X1.5 Y-2 F100\nX3\n", {});
  CHECK(moves.back() == "none");
  for (const char* text : {"G1 X1.5 Y-2 F100\r\nX3\r\n", "G1 X1.5 Y-2 F100\nX3", "G1 X1.5 Y-2 F100\r\r\nX3\r",
                           "G1 X1.5 Y-2 F100 \t\nX3 ", "G1 X1.5 Y-2 F100\x1a\nX3\x1a"})
    CHECK(found_in(begin + text, {}) == moves);
}

TEST_CASE("a line of common words gets a remark from ten characters below the limit of its control on") {
  constexpr std::size_t limit = 255;
  for (std::size_t length = limit - 20; length <= limit; ++length) {
    CAPTURE(length);
    const std::string line = "G1 X1" + std::string(length - 7, ' ') + "Y2";
    const Program program = read("G21 G90 G0 X0 Y0 Z0\n" + line + "\nX1\n", "linuxcnc");
    CHECK(program.remarks.size() == (length + 10 > limit ? 1 : 0));
  }
}
