#pragma once
/// Programs made up for timing.
#include <fmt/format.h>

#include <iterator>
#include <string>

namespace counterflex::bench {

/// `blocks` short feed moves, back and forth over a patch of 60 by 20 mm, 1.2 mm a move, with a force and
/// some clearing moves: about what a CAM system writes for a face. Program coordinates lie in the
/// Orthoglide's workspace, in mm.
inline std::string face_program(int blocks) {
  std::string text =
      "%\n(FACE)\nG21 G90 G94\nG54 S6000 M3\nG0 X-30. Y-10. Z5.\nG1 Z0. F300\n(FORCE FX=215 FY=-10 FZ=-25)\n";
  constexpr int columns = 50;
  for (int i = 1; i < blocks; ++i) {
    const int row = i / columns, column = row % 2 == 0 ? i % columns : columns - 1 - i % columns;
    text += fmt::format("G1 X{:.3f} Y{:.3f}{}\n", -30 + 1.2 * column, -10 + 0.02 * i, i == 1 ? " F900" : "");
  }
  return text + "(FORCE OFF)\nG0 Z5.\nM30\n%\n";
}

/// About `bytes` of what a CAM system writes for a mould: short lines that omit what stays, now and then an
/// arc, a feed and a retract; in mm, as LinuxCNC and GRBL read it.
inline std::string mould_program(std::size_t bytes) {
  std::string text = "%\n(MOULD)\nG21 G90 G94 G17\nG54 S12000 M3\nG0 X0. Y0. Z5.\nG1 Z0. F300\n";
  text.reserve(bytes + 256);
  for (int i = 1; text.size() < bytes; ++i) {
    const double x = 0.05 * (i % 2000), y = 0.1 * (i / 2000 % 1000), z = -0.001 * (i % 700);
    const auto out = std::back_inserter(text);
    if (i % 2000 == 0)
      fmt::format_to(out, "G0 Z5.\nX0. Y{:.3f}\nG1 Z0. F300\n", y);
    else if (i % 40 == 0)
      fmt::format_to(out, "G3 X{:.3f} Y{:.3f} I-0.5 J0. F800\nG1 X{:.3f} F1200\n", x - 1, y, x);
    else if (i % 3 == 0)
      fmt::format_to(out, "X{:.3f} Y{:.3f} Z{:.4f}\n", x, y, z);
    else
      fmt::format_to(out, "X{:.3f} Z{:.4f}\n", x, z);
  }
  return text + "G0 Z5.\nM30\n%\n";
}

}  // namespace counterflex::bench
