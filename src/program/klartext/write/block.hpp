#pragma once
/// The new text of an edited Klartext block, and of the blocks inserted around it.
#include <optional>
#include <string>

#include "counterflex/program/rewrite.hpp"
#include "program/klartext/lex.hpp"
#include "program/klartext/write/numbers.hpp"
#include "program/klartext/write/style.hpp"

namespace counterflex {

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

/// Enters the position after `move` if it makes a hole without a word of its own for the surface: the cycle
/// ends it at the surface in the text.
void reach_surface(const Move& move, KlartextTextState& state);

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
