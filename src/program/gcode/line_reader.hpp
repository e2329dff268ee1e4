#pragma once
/// Reads the lines of G-code, one after the other, into one program.
#include "program/block_reader.hpp"
#include "program/gcode/interpret.hpp"

namespace counterflex {

class LineReader final : public BlockReader {
 public:
  LineReader(const std::string& file, const ReadOptions& options, const Dialect& dialect, Outline outline);

  bool read_block() override;
  void read_plain(std::size_t most_moves) override;
  std::size_t position() const override { return block_.line_end.end; }
  bool has_ended() const override { return ended_; }
  bool may_end_before(const Move& last, bool anywhere) const override;

 private:
  int end_line() const override { return reading_.ended ? block_.line : 0; }
  void resume_behind(std::size_t read) override;
  bool read_any_line();

  Reading reading_;
  Block block_;
  bool opened_ = false, ended_ = false;
  bool takes_plain_ = false;  ///< `takes_plain_lines`
};

}  // namespace counterflex
