#pragma once
/// Writes G-code, also for a Sinumerik.
#include "program/program_writer.hpp"
#include "program/write/original_block.hpp"
#include "program/write/text_state.hpp"

namespace counterflex {

class GcodeWriter final : public ProgramWriter {
 public:
  GcodeWriter(const Program& window, const WriteOptions& options)
      : options_(options), style_(style_of(window)) {}

  Rewritten write(const Program& window, const std::vector<MoveEdit>& edits) override;

 private:
  WriteOptions options_;
  ProgramStyle style_;
  TextState text_;
  bool begun_ = false, guarded_ = false;
};

}  // namespace counterflex
