#pragma once
/// Reads the lines of a text that grows, one after the other, into one program.
#include <string>
#include <string_view>

#include "program/interpret.hpp"

namespace counterflex {

/// A dialect shows at the beginning of a program: bytes of it.
inline constexpr std::size_t looked_at = 1 << 20;

/// The dialect of `options`, or the one that `text`, of which only the beginning counts, shows. Throws
/// `UnknownDialect` where there is none of that name.
const Dialect& choose_dialect(std::string_view text, const std::string& file, const ReadOptions& options);

/// Axes that are unknown after a tool change.
std::array<bool, 3> axes_of_tool_change(const Dialect& dialect, const ReadOptions& options);

class LineReader {
 public:
  LineReader(const std::string& file, const ReadOptions& options, const Dialect& dialect, Outline outline);
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  Program& program() { return program_; }
  const Program& program() const { return program_; }
  const ReadOptions& options() const { return options_; }
  const Dialect& dialect() const { return dialect_; }
  const Outline& outline() const { return reading_.outline; }

  /// Reads the next line of the program's text; false where there is none, or behind the program's end.
  bool read_line();

  /// Reads on while lines are plain, until the program has `most_moves`: much faster than line by line.
  void read_plain(std::size_t most_moves);

  /// Reads all lines of the program's text.
  void read_all();

  /// Behind the last line that was read.
  std::size_t position() const { return block_.line_end.end; }
  bool has_ended() const { return ended_; }

  /// Whether a window may end before the line that was read last, which the one move `last` is of. `anywhere`: also
  /// before a line along Z.
  bool may_end_before(const Move& last, bool anywhere) const;

  /// Says, once, what `text` behind the program's end means.
  void remark_rest(std::string_view text);

  /// Text, moves and blocks left alone of the program are taken away; reading goes on in the text that
  /// follows them, `read` bytes of which have been read already and gave the `first` move.
  void begin_window(std::size_t read, std::optional<Move> first);

  /// Moves text, moves and blocks left alone of the window into `to`, and copies all else but the remarks;
  /// the room that `to` had is used for the next window.
  void take_window(Program& to);

 private:
  bool read_any_line();

  const ReadOptions options_;
  const Dialect& dialect_;
  Program program_;
  Reading reading_;
  Block block_;
  bool opened_ = false, ended_ = false;
  bool takes_plain_ = false;  ///< `takes_plain_lines`
};

}  // namespace counterflex
