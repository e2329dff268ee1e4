#pragma once
/// Reads the blocks of Klartext, one after the other, into one program.
#include "program/block_reader.hpp"
#include "program/klartext/read.hpp"

namespace counterflex {

class KlartextReader final : public BlockReader {
 public:
  KlartextReader(const std::string& file, const ReadOptions& options, const Dialect& dialect,
                 Outline outline);

  bool read_block() override;
  std::size_t position() const override { return block_.line_end.end; }
  bool has_ended() const override { return reading_.ended; }
  bool may_end_before(const Move& last, bool anywhere) const override;

 private:
  int end_line() const override { return block_.head == "END" ? block_.line : 0; }
  void resume_behind(std::size_t read) override;

  KlartextReading reading_;
  KlartextBlock block_;
};

/// Whether `text` has the header of a corrected program.
bool is_corrected_klartext(std::string_view text);

}  // namespace counterflex
