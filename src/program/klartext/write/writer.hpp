#pragma once
/// Writes corrected Klartext.
#include "program/klartext/write/block.hpp"
#include "program/program_writer.hpp"

namespace counterflex {

class KlartextWriter final : public ProgramWriter {
 public:
  KlartextWriter(const Program& window, const WriteOptions& options)
      : options_(options), style_(klartext_style(window)) {}

  /// Renumbers the blocks without gaps from the begin of the window on, if they have numbers and one was
  /// inserted.
  Rewritten write(const Program& window, const std::vector<MoveEdit>& edits) override;

 private:
  WriteOptions options_;
  KlartextStyle style_;
  KlartextTextState text_;
  bool begun_ = false, guarded_ = false;
};

}  // namespace counterflex
