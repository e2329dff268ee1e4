#pragma once
/// A program in which a bit of everything happens.
#include <fmt/format.h>

#include "compensation/support/shop.hpp"

namespace counterflex::test {

/// Pockets with helices, arcs, a contour under G41, holes, relative moves, changes of tools and of the work
/// offset, and a raster without a rapid.
inline std::string busy_program() {
  std::string blocks = "%\nG21 G90 G17 G54\nT1 M6\nS3000 M3\nG0 X0 Y0\nG43 H1 Z5\n";
  for (int pocket = 0; pocket < 4; ++pocket) {
    const int x = 10 * pocket;
    blocks += fmt::format("(POCKET {})\nG0 X{} Y0 Z2\nG1 Z0 F300\nG2 X{} Y0 Z-1 I2 J0\nG1 X{}.5 F500\nY3\n",
                          pocket, x, x, x);
    blocks +=
        fmt::format("G3 X{} Y3 R1.5\nG1 Y0\nG91\nX-0.5\nY1.25\nX0.4 Y-0.2\nG90\nX{} Y0\nG0 Z5\n", x - 2.5, x);
  }
  blocks += "G0 X5 Y-5\nZ-1\nG41 D1 G1 X6 Y-4 F400\nX15\nY3\nX6\nY-4\nG40 X5 Y-5\nG0 Z5\n";
  blocks += "G98 G81 X2 Y2 Z-3 R1 F100\nX4\nX6 Y4\nG80\nG0 X0 Y0\nG55\nG0 X1 Y1 Z1\nG1 Z-0.5\n";
  for (int row = 0; row < 12; ++row)
    blocks += fmt::format("X{}\nY{:.2f}\n", row % 2 == 0 ? 20 : 1, 1 + 0.25 * (row + 1));
  return blocks + "G0 Z5\nG53 G0 Z0\nX0 Y0\nZ3\nX1\nM30\n%\n(THE END)\n";
}

/// On the mill of the samples, at its G54.
inline Order on_mill(std::string program) {
  const Machine machine = read_machine(read_file(mill), "mill");
  return {.machine = machine, .text = std::move(program), .X_MW = machine.work.at("G54").X_MW};
}

}  // namespace counterflex::test
