#pragma once
/// Programs made up for timing.
#include <fmt/format.h>

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

}  // namespace counterflex::bench
