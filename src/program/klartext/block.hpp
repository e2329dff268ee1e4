#pragma once
/// The new text of one edited Klartext block, and of those that are put around it.
#include <optional>
#include <string>

#include "counterflex/program/rewrite.hpp"
#include "program/klartext/lex.hpp"
#include "program/klartext/numbers.hpp"

namespace counterflex {

/// How a program writes what is inserted.
struct KlartextStyle {
  bool comma = false;     ///< decimals stand behind a comma
  bool plus = false;      ///< "X+1"
  bool numbered = false;  ///< blocks begin with numbers
  bool n_words = false;   ///< "N5" instead of "5"
  std::string line_end = "\n";
};

/// The last CC of the written text.
struct HeldPole {
  std::optional<Vector3> centre_mm{};  ///< none where it counts from a position
  bool differs = false;                ///< it is not that of the original
};

/// What the text written so far leaves to the blocks that follow.
struct KlartextTextState {
  HeldPosition held{};
  HeldPole pole{};
  std::optional<double> surface{};  ///< of the cycle that acts, as the text says it; none: as the original does
  WrittenNumbers numbers{};
};

KlartextStyle klartext_style(const Program& program);

/// `value` as `style` writes it.
std::string klartext_number(const KlartextStyle& style, double value, int decimals);

/// Characters put in place of a span of the program.
struct KlartextChange {
  Span span;
  std::string text;
};

/// Appends to `changes` what `edit` asks for, in the order of the text, moves `state` on and counts in `out`. Inserted
/// lines of a numbered program begin with the number 0.
void rewrite_klartext_block(const Program& program, const KlartextStyle& style, const MoveEdit& edit,
                            const WriteOptions& options, KlartextTextState& state,
                            std::vector<KlartextChange>& changes, Rewritten& out);

}  // namespace counterflex
