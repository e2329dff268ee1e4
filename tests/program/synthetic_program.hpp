#pragma once
/// Random programs in the styles of real ones.
#include <cstdint>
#include <random>
#include <string>

namespace counterflex::test {

/// A generator of the same programs with every standard library: it uses only raw bits of the engine.
class SyntheticProgram {
 public:
  explicit SyntheticProgram(std::uint64_t seed) : bits_(seed) {}

  /// A supported program of about `blocks` blocks.
  std::string text(int blocks);

 private:
  int below(int n) { return static_cast<int>(bits_() % static_cast<std::uint64_t>(n)); }
  bool chance(int percent) { return below(100) < percent; }
  char letter(char upper) const { return lower_ ? static_cast<char>(upper - 'A' + 'a') : upper; }
  void word(std::string& line, char name, const std::string& number);
  std::string number();
  void coordinates(std::string& line, int percent);
  std::string block();
  std::string other_line();

  std::mt19937_64 bits_;
  bool lower_ = false;
  bool dense_ = false;
  bool numbered_ = false;
  bool inch_ = false;
  int decimals_ = 3;
  int next_number_ = 10;
};

inline void SyntheticProgram::word(std::string& line, char name, const std::string& number) {
  if (!line.empty() && line.back() != '/' && !dense_) line += ' ';
  line += letter(name);
  line += number;
}

inline std::string SyntheticProgram::number() {
  std::string text = chance(50) ? "-" : chance(10) ? "+" : "";
  if (!chance(10)) text += std::to_string(below(inch_ ? 4 : 100));
  const int style = below(10);
  if (style == 0 && text.find_first_of("0123456789") != std::string::npos) return text;
  const bool has_digits = text.find_first_of("0123456789") != std::string::npos;
  text += '.';
  const int digits = style < 3 ? (has_digits ? 0 : 1) : decimals_;
  for (int i = 0; i < digits; ++i) text += static_cast<char>('0' + below(10));
  return text;
}

inline void SyntheticProgram::coordinates(std::string& line, int percent) {
  const std::size_t before = line.size();
  for (const char axis : {'X', 'Y', 'Z'})
    if (chance(percent)) word(line, axis, number());
  if (line.size() == before) word(line, 'X', number());
}

inline std::string SyntheticProgram::block() {
  std::string line;
  if (chance(3)) line += '/';
  if (numbered_) word(line, 'N', std::to_string(next_number_++));
  if (line.empty() || line.front() != '/')
    if (chance(20)) word(line, 'G', chance(30) ? "0" : chance(50) ? "1" : "01");
  coordinates(line, 50);
  if (chance(15)) word(line, 'F', std::to_string(100 + below(900)) + (chance(50) ? "." : ""));
  if (chance(3)) word(line, 'M', chance(50) ? "8" : "9");
  if (chance(5)) line += " (edge " + std::to_string(below(9)) + ")";
  if (chance(5)) line += " \t";
  return line;
}

inline std::string SyntheticProgram::other_line() {
  switch (below(8)) {
    case 0:
      return "";
    case 1:
      return "(N\xc3\xa4"
             "chste Kante; X1 Y2)";
    case 2:
      return "; remark (with X1";
    case 3:
      return "M3 S" + std::to_string(below(9000));
    case 4:
      return "G4 P0.5";
    case 5:
      return "G53 G0 Z0";
    case 6:
      return chance(50) ? "G54" : "G55";
    default:
      return "(FORCE FX=" + std::to_string(below(90)) + ")";
  }
}

inline std::string SyntheticProgram::text(int blocks) {
  lower_ = chance(20);
  dense_ = chance(30);
  numbered_ = chance(40);
  inch_ = chance(30);
  decimals_ = (inch_ ? 4 : 3) + below(3) - 1;
  const std::string line_end = chance(30) ? "\r\n" : "\n";
  std::string text = chance(50) ? "%" + line_end : "";
  text += (inch_ ? "G20" : "G21") + line_end + "G90 G17 G40" + line_end + "G0 X0 Y0" + line_end + "F500" +
          line_end;
  for (int i = 0; i < blocks; ++i) text += (chance(10) ? other_line() : block()) + line_end;
  if (chance(50)) text += "M30" + line_end + "anything [at all" + line_end;
  if (chance(30)) text.erase(text.size() - line_end.size());
  return text;
}

}  // namespace counterflex::test
