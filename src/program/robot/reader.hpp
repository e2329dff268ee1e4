#pragma once
/// Reads the lines of a robot program, one after the other, into one program. A language derives from it.
#include "program/block_reader.hpp"
#include "program/robot/reading.hpp"

namespace counterflex {

class RobotReader : public BlockReader {
 public:
  /// `comment_mark` begins a comment. `form` is how the language writes orientations.
  RobotReader(const std::string& file, const ReadOptions& options, const Dialect& dialect, Outline outline,
              std::string_view comment_mark, OrientationForm form);

  bool read_block() override;
  std::size_t position() const override { return line_.line_end.end; }
  bool has_ended() const override { return reading_.ended; }
  bool may_end_before(const Move& last, bool anywhere) const override;

 protected:
  RobotReading& reading() { return reading_; }

  /// Moves `line` to the next statement, as `next_robot_line` does.
  virtual bool next_line(RobotLine& line) const;

  /// Reads the statement of a line with code. Sets `RobotReading::ended` at the end of the program.
  virtual void read_statement(const RobotLine& line) = 0;

  /// Reads the comment of a line; by default as `read_robot_comment`.
  virtual void read_comment(const RobotLine& line);

 private:
  int end_line() const override { return reading_.ended ? line_.line : 0; }
  void resume_behind(std::size_t read) override;

  RobotReading reading_;
  RobotLine line_;
  const std::string_view comment_mark_;
};

/// Whether a comment before the first move is the header of a corrected program.
bool is_corrected_robot_program(std::string_view text, std::string_view comment_mark);

}  // namespace counterflex
