#pragma once
/// Random Klartext: lines, arcs about CC and by radius, polar blocks, contours, holes, labels and jumps,
/// shifted and rotated coordinates, blocks of several lines, with numbers or without.
#include <fmt/format.h>

#include <cmath>
#include <random>
#include <string>

namespace counterflex::test {

class SyntheticKlartext {
 public:
  explicit SyntheticKlartext(std::uint64_t seed) : bits_(seed) {}

  std::string text(int statements) {
    numbered_ = chance(50);
    poles_ = chance(30);
    labels_ = chance(40);
    add("BEGIN PGM SYNTHETIC MM");
    add("TOOL CALL 1 Z S3000 F500");
    add("L X+0 Y+0 Z+50 R0 FMAX M3");
    for (int i = 0; i < statements; ++i) statement();
    if (contour_) add("L X+0 Y+0 R0");
    if (open_) add("LBL 0");
    add("L Z+50 FMAX M30");
    add("END PGM SYNTHETIC MM");
    if (chance(10)) text_ += "0 BEGIN PGM NEXT MM\n1 L X+5\n2 END PGM NEXT MM\n";
    return text_;
  }

 private:
  int below(int n) { return static_cast<int>(bits_() % static_cast<std::uint64_t>(n)); }
  bool chance(int percent) { return below(100) < percent; }

  void add(const std::string& statement) {
    if (chance(5)) text_ += "; COMMENT " + std::to_string(number_) + "\n";
    if (numbered_) text_ += std::to_string(number_++) + " ";
    text_ += statement + "\n";
  }

  std::string place(char axis, int size = 60) {
    return fmt::format(" {}{:+.2f}", axis, (below(2 * size) - size) / 4.0);
  }

  void line() {
    std::string words;
    if (chance(70)) words += place('X');
    if (chance(60)) words += place('Y');
    if (words.empty() || chance(20)) words += place('Z', 20);
    if (chance(8)) words = fmt::format(" IX{:+.1f} IY-0.5", 0.5 * below(6));
    add("L" + words + (chance(15) ? " FMAX" : "") + (chance(10) ? " ~\n  F300" : ""));
  }

  void arc() {
    if (contour_) return line();
    const int x = below(40) - 20, y = below(40) - 20;
    if (chance(30)) {
      add(fmt::format("L X{:+d} Y{:+d}", x, y));
      return add(fmt::format("CR X{:+d} Y{:+d} R{}10 DR{}", x + 8, y + 6, chance(50) ? "+" : "-",
                             chance(50) ? "+" : "-"));
    }
    const bool behind = chance(50);  // of the CC
    if (!behind) add(fmt::format("L X{:+d} Y{:+d}", x + 5, y));
    add(fmt::format("CC X{:+d} Y{:+d}", x, y));
    if (behind) {
      add(fmt::format("L X{:+d} Y{:+d}", x + 5, y));
      for (int i = chance(10) ? 20 : below(3); i > 0; --i) add(place('Z', 20).insert(0, "L"));
    }
    if (chance(20)) return add(fmt::format("CP IPA+{} IZ-1 DR+", 90 * (1 + below(8))));
    for (int i = 1 + below(3); i > 0; --i)
      add(fmt::format("C X{:+d} Y{:+d} DR{}", i % 2 == 1 ? x : x + 5, i % 2 == 1 ? y + 5 : y,
                      chance(50) ? "+" : "-"));
    if (chance(20)) add(fmt::format("LP PR+{} PA{:+d}", 2 + below(9), 10 * (below(36) - 18)));
    if (poles_ && chance(10)) add("CTP PA+30");
  }

  void contour() {
    if (open_) return line();
    add(contour_ ? "L X+30 Y+30 R0" : "L X+10 Y+10 RL F400");
    contour_ = !contour_;
  }

  void holes() {
    if (contour_) return line();
    add(fmt::format("CYCL DEF 200 DRILLING ~\n  Q200=2 ~\n  Q201=-10 ~\n  Q203={:+d} ~\n  Q204=50",
                    below(3)));
    for (int i = below(3); i > 0; --i) line();
    for (int i = 1 + below(3); i > 0; --i) add("L" + place('X') + place('Y') + " R0 FMAX M99");
    add("L Z+40 FMAX");
  }

  void frame() {
    if (contour_ || open_) return line();
    if (chance(50)) {
      add("CYCL DEF 7.0 DATUM");
      add("CYCL DEF 7.1 X" + std::to_string(below(9)));
    } else {
      add("CYCL DEF 10.0 ROTATION");
      add("CYCL DEF 10.1 ROT+" + std::to_string(15 * below(4)));
    }
    add("L X+0 Y+0 Z+20 FMAX");
  }

  void label() {
    if (!labels_ || contour_) return line();
    if (chance(15)) return add("FN 9: IF +Q1 EQU +1 GOTO LBL " + std::to_string(1 + below(label_ + 1)));
    if (open_) return open_ = false, add("LBL 0");
    if (label_ > 0 && chance(30))
      return add("CALL LBL " + std::to_string(1 + below(label_)) + (chance(40) ? " REP 2" : ""));
    open_ = true;
    add("LBL " + std::to_string(++label_));
  }

  void statement() {
    const int kind = below(100);
    if (kind < 55) return line();
    if (kind < 75) return arc();
    if (kind < 80) return contour();
    if (kind < 85) return holes();
    if (kind < 88) return frame();
    if (kind < 93) return label();
    if (kind < 95 && !contour_) return add("TOOL CALL " + std::to_string(1 + below(9)) + " Z S2000");
    if (kind < 97 && !contour_) return add(chance(50) ? "L Z+80 FMAX M91" : "L X+Q5");
    if (kind < 98) return add("RND R0.5"), add("L X+20.5 Y-3");
    add("M8");
  }

  std::mt19937_64 bits_;
  std::string text_;
  int number_ = 0, label_ = 0;
  bool numbered_ = false, poles_ = false, labels_ = false, contour_ = false, open_ = false;
};

}  // namespace counterflex::test
