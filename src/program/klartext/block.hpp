#pragma once
/// The new text of an edited Klartext block, and of the blocks inserted around it.
#include <optional>
#include <string>

#include "counterflex/program/rewrite.hpp"
#include "program/klartext/lex.hpp"
#include "program/klartext/numbers.hpp"

namespace counterflex {

/// Style of inserted text in a program.
struct KlartextStyle {
  bool comma = false;     ///< decimal comma
  bool plus = false;      ///< "X+1"
  bool numbered = false;  ///< blocks begin with numbers
  bool n_words = false;   ///< "N5" instead of "5"
  std::string line_end = "\n";
};

/// The last CC of the written text.
struct WrittenPole {
  std::optional<Vector3> centre_mm{};  ///< empty if it is relative to a position
  bool differs = false;                ///< it is not the CC of the original
};

/// State of the written text that affects later blocks.
struct KlartextTextState {
  TextPosition position{};
  WrittenPole pole{};
  std::optional<double> surface{};  ///< surface of the active cycle in the text; empty: as in the original
  WrittenNumbers numbers{};
};

KlartextStyle klartext_style(const Program& program);

/// `value` in `style`.
std::string klartext_number(const KlartextStyle& style, double value, int decimals);

/// Characters that replace a span of the program.
struct KlartextChange {
  Span span;
  std::string text;
};

/// Appends the changes of `edit` to `changes` in the order of the text, updates `state` and counts in `out`.
/// In a numbered program inserted lines begin with the number 0.
void rewrite_klartext_block(const Program& program, const KlartextStyle& style, const MoveEdit& edit,
                            const WriteOptions& options, KlartextTextState& state,
                            std::vector<KlartextChange>& changes, Rewritten& out);

}  // namespace counterflex
