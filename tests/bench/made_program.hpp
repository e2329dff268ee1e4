#pragma once
/// Generated programs for timing.
#include <fmt/format.h>

#include <iterator>
#include <string>

namespace counterflex::bench {

/// About `bytes` of a program as a CAM system writes it for a mould: short lines without unchanged words,
/// some arcs, a feed and a retract; in mm, as LinuxCNC and GRBL read it.
inline std::string mould_program(std::size_t bytes) {
  std::string text = "%\n(MOULD)\nG21 G90 G94 G17\nG54 S12000 M3\nG0 X0. Y0. Z5.\nG1 Z0. F300\n";
  text.reserve(bytes + 256);
  for (int i = 1; text.size() < bytes; ++i) {
    const double x = 0.05 * (i % 2000), y = 0.1 * (i / 2000 % 1000), z = -0.001 * (i % 700);
    const auto out = std::back_inserter(text);
    if (i % 2000 == 0)
      fmt::format_to(out, "G0 Z5.\nX0. Y{:.3f}\nG1 Z0. F300\n", y);
    else if (i % 40 == 0)
      fmt::format_to(out, "G3 X{:.3f} Y{:.3f} I-0.5 J0. F800\nG1 X{:.3f} F1200\n", x - 1.05, y, x);
    else if (i % 3 == 0)
      fmt::format_to(out, "X{:.3f} Y{:.3f} Z{:.4f}\n", x, y, z);
    else
      fmt::format_to(out, "X{:.3f} Z{:.4f}\n", x, z);
  }
  return text + "G0 Z5.\nM30\n%\n";
}

/// About `bytes` of a finishing program with numbered blocks and all words: "N1230 G1 X.. Y.. Z..".
inline std::string numbered_program(std::size_t bytes) {
  std::string text =
      "%\n(FINISH)\nN10 G21 G90 G94 G17\nN20 G54 S12000 M3\nN30 G0 X0. Y0. Z5.\nN40 G1 Z0. F1200\n";
  text.reserve(bytes + 256);
  for (int i = 1; text.size() < bytes; ++i)
    fmt::format_to(std::back_inserter(text), "N{} G1 X{:.3f} Y{:.3f} Z{:.3f}{}\n", 40 + 10 * i,
                   0.053 * (i % 2000) - 41, 0.1 * (i / 2000 % 1000) + 0.007 * (i % 13), -0.001 * (i % 1700),
                   i % 500 == 0 ? " F1500" : "");
  return text + "G0 Z5.\nM30\n%\n";
}

/// About `bytes` of trochoidal milling: every second block an arc, now and then a helical one or one with R.
inline std::string arc_program(std::size_t bytes) {
  std::string text = "%\n(SLOTS)\nG21 G90 G94 G17\nG54 S12000 M3\nG0 X0. Y0. Z5.\nG1 Z0. F1200\n";
  text.reserve(bytes + 256);
  for (int i = 1; text.size() < bytes; ++i) {
    const double x = 0.25 * (i % 400), y = 0.1 * (i / 400 % 1000);
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "G1 X{:.3f} Y{:.3f}\n", x, y);
    if (i % 7 == 0)
      fmt::format_to(out, "G2 X{:.3f} Y{:.3f} R2.5\n", x + 3, y + 4);
    else if (i % 5 == 0)
      fmt::format_to(out, "G3 X{:.3f} Y{:.3f} Z{:.3f} I-1.500 J2.000\n", x - 3, y + 4, -0.01 * (i % 50));
    else
      fmt::format_to(out, "G3 X{:.3f} Y{:.3f} I-1.500 J2.000\n", x - 3, y + 4);
  }
  return text + "G0 Z5.\nM30\n%\n";
}

}  // namespace counterflex::bench
