#pragma once
/// Short programs in Klartext.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "program/reading.hpp"

namespace counterflex::test {

/// A program in Klartext around `blocks`, numbered.
inline std::string klartext(const std::vector<std::string>& blocks, const std::string& unit = "MM") {
  std::string text = "0 BEGIN PGM COVER " + unit + "\n";
  int number = 1;
  for (const std::string& block : blocks) text += fmt::format("{} {}\n", number++, block);
  return text + fmt::format("{} END PGM COVER {}\n", number, unit);
}

/// With calls replaced by the blocks that they call.
inline Program expanded_klartext(const std::string& text) {
  ReadOptions options;
  options.expand_subprograms = true;
  return read_program(text, "p.h", options);
}

inline const Vector3 klartext_shift(0.5, -0.25, 0.125);

/// The text of `program`, shifted by `klartext_shift`.
inline std::string klartext_shifted(const Program& program, const WriteOptions& options = {}) {
  return shifted_text(program, klartext_shift, options);
}

/// The message with which a program of `blocks` is refused.
inline std::string klartext_refusal(const std::vector<std::string>& blocks) {
  return diagnostic_of([&] { read(klartext(blocks)); });
}

}  // namespace counterflex::test
