#pragma once
/// Random programs of lines and arcs in all formats: planes, I J K or R, absolute centres, omitted words,
/// helices, full circles, relative words, inches, G93.
#include <fmt/format.h>

#include <cmath>
#include <random>
#include <string>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex::test {

class SyntheticArcs {
 public:
  explicit SyntheticArcs(std::uint64_t seed, double smallest = 2, double largest = 15)
      : bits_(seed), smallest_(smallest), largest_(largest) {}

  /// A program of `blocks` moves. All its arcs are valid for a control.
  std::string text(int blocks);

 private:
  int below(int n) { return static_cast<int>(bits_() % static_cast<std::uint64_t>(n)); }
  bool chance(int percent) { return below(100) < percent; }
  double between(double a, double b) { return a + (b - a) * below(1000001) / 1e6; }
  double grid(double value) const { return rounded(value, decimals_); }
  void word(char letter, double value);
  void end_words(const Vector3& end, bool all);
  void line();
  void arc();
  void modes();
  void finish();

  std::mt19937_64 bits_;
  double smallest_, largest_;  ///< radii, in the program's unit
  std::string text_, block_;
  Vector3 at_ = Vector3::Zero();  ///< as read back
  int decimals_ = 3, normal_ = 2, written_motion_ = -1;
  bool relative_ = false, absolute_centre_ = false, dense_ = false, lower_ = false, timed_ = false;
};

inline void SyntheticArcs::word(char letter, double value) {
  if (!block_.empty() && block_ != "/" && !dense_) block_ += ' ';
  block_ += lower_ ? static_cast<char>(letter - 'A' + 'a') : letter;
  block_ += format_fixed(value, decimals_);
}

/// The words of `end`, which is on the grid. Unchanged coordinates are written only if `all`.
inline void SyntheticArcs::end_words(const Vector3& end, bool all) {
  for (int axis = 0; axis < 3; ++axis) {
    const double value = grid(relative_ ? end[axis] - at_[axis] : end[axis]);
    const bool same = grid(end[axis]) == grid(at_[axis]);
    if (!same || (all && axis != normal_)) word(static_cast<char>('X' + axis), value);
    at_[axis] = relative_ ? at_[axis] + value : value;
  }
}

inline void SyntheticArcs::finish() {
  if (timed_)
    block_ += fmt::format("{}F{}.5", dense_ ? "" : " ", 2 + below(90));
  else if (chance(10))
    block_ += fmt::format("{}F{}.", dense_ ? "" : " ", 100 + below(900));
  if (chance(4)) block_ += dense_ ? "M8" : " M8";
  text_ += block_ + "\n";
}

inline void SyntheticArcs::line() {
  block_ = chance(3) ? "/" : "";
  if (block_.empty() && (written_motion_ != 1 || chance(30))) block_ = "G1", written_motion_ = 1;
  if (written_motion_ != 1) block_ += "G1";
  Vector3 end = at_;
  for (int axis = 0; axis < 3; ++axis)
    if (chance(60)) end[axis] = grid(between(-20, 20));
  end[0] = grid(end[0] + 1);
  // After a skippable block all coordinates are programmed again, absolute.
  const bool skippable = block_.starts_with('/');
  if (skippable && relative_) text_ += "G90\n", relative_ = false;
  end_words(end, false);
  finish();
  if (!skippable) return;
  text_ += fmt::format("G1 X{} Y{} Z{} F30.\n", format_fixed(at_.x(), decimals_),
                       format_fixed(at_.y(), decimals_), format_fixed(at_.z(), decimals_));
  written_motion_ = 1;
}

inline void SyntheticArcs::arc() {
  const bool clockwise = chance(50), full = chance(10), by_radius = !full && chance(30);
  const int motion = clockwise ? 2 : 3;
  block_.clear();
  if (written_motion_ != motion || chance(50)) block_ = fmt::format("{}{}", lower_ ? "g0" : "G", motion);
  written_motion_ = motion;
  const int a = (normal_ + 1) % 3, b = (normal_ + 2) % 3;
  const double angle = between(0, 6.28), size = between(smallest_, largest_);
  double sweep = (clockwise ? -1 : 1) * between(0.2, by_radius ? 2.5 : 5.5);
  if (by_radius && chance(30)) sweep *= 2;
  if (std::abs(std::abs(sweep) - 3.14) < 0.5 && by_radius) sweep *= 0.5;
  Vector3 centre = at_, end = at_;
  centre[a] = grid(at_[a] - size * std::cos(angle));
  centre[b] = grid(at_[b] - size * std::sin(angle));
  if (!full) end[a] = grid(centre[a] + size * std::cos(angle + sweep));
  if (!full) end[b] = grid(centre[b] + size * std::sin(angle + sweep));
  if (chance(20)) end[normal_] = grid(at_[normal_] + between(-3, 3));
  const Vector3 start = at_;
  end_words(end, chance(60));
  if (by_radius) {
    word('R', std::abs(sweep) > 3.14159 ? -size : size);
  } else {
    for (const int axis : {std::min(a, b), std::max(a, b)}) {
      const double value = grid(centre[axis] - (absolute_centre_ ? 0 : start[axis]));
      if (value != 0 || absolute_centre_ || chance(50)) word(static_cast<char>('I' + axis), value);
    }
  }
  finish();
}

inline void SyntheticArcs::modes() {
  std::string codes;
  if (chance(40)) normal_ = below(3), codes += fmt::format("G{} ", 19 - normal_);
  if (chance(40)) relative_ = !relative_, codes += relative_ ? "G91 " : "G90 ";
  if (chance(40)) absolute_centre_ = !absolute_centre_, codes += absolute_centre_ ? "G90.1 " : "G91.1 ";
  if (chance(30)) timed_ = !timed_, codes += timed_ ? "G93 " : "G94 F100. ";
  if (!codes.empty()) text_ += codes + "\n";
}

inline std::string SyntheticArcs::text(int blocks) {
  dense_ = chance(30);
  lower_ = chance(20);
  const bool inch = chance(30);
  decimals_ = (inch ? 4 : 3) + below(2);
  at_.setZero();
  normal_ = 2;
  written_motion_ = 1;
  relative_ = absolute_centre_ = timed_ = false;
  text_ = inch ? "G20\n" : "G21\n";
  text_ += "G90 G17 G40\nG1 X0. Y0. Z0. F200.\n";
  for (int i = 0; i < blocks; ++i) {
    if (chance(8)) modes();
    if (chance(40))
      line();
    else
      arc();
  }
  return text_ + "M30\n";
}

}  // namespace counterflex::test
