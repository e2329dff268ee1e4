#pragma once
/// Reads the blocks of a growing text, one after the other, into one program.
#include <memory>
#include <string>
#include <string_view>

#include "counterflex/program/program.hpp"
#include "counterflex/program/read_program.hpp"
#include "program/dialect.hpp"
#include "program/outline.hpp"

namespace counterflex {

class BlockReader {
 public:
  BlockReader(const std::string& file, const ReadOptions& options, const Dialect& dialect, Outline outline);
  virtual ~BlockReader() = default;
  BlockReader(const BlockReader&) = delete;
  BlockReader& operator=(const BlockReader&) = delete;

  Program& program() { return program_; }
  const Program& program() const { return program_; }
  const ReadOptions& options() const { return options_; }
  const Dialect& dialect() const { return dialect_; }
  const Outline& outline() const { return outline_; }

  /// Reads the next block of the program's text. False at the end of the text and behind the end of the
  /// program.
  virtual bool read_block() = 0;

  /// Reads plain blocks until the program has `most_moves` or a block is not plain. Much faster than block by
  /// block. May read no block.
  virtual void read_plain(std::size_t most_moves);

  /// Reads all blocks of the program's text.
  void read_all();

  /// Position behind the last block that was read.
  virtual std::size_t position() const = 0;

  virtual bool has_ended() const = 0;

  /// Whether a window may end before the last block that was read, whose move is `last`. `anywhere`: also
  /// before a line along Z.
  virtual bool may_end_before(const Move& last, bool anywhere) const = 0;

  /// Whether the text can only be read as one window.
  bool is_read_whole() const {
    return options_.expand_subprograms || !outline_.klartext.poles.empty() || outline_.named_targets;
  }

  /// Adds a remark, once, if `text` behind the program's end is not empty.
  void remark_rest(std::string_view text);

  /// Begins the next window: clears text, moves and uncorrected blocks. The first `read` bytes of the next
  /// text were read already; their move is `first`.
  void begin_window(std::size_t read, std::optional<Move> first);

  /// Moves text, moves and uncorrected blocks of the window into `to`. Copies the rest except the remarks.
  /// Reuses the memory of `to` for the next window.
  void take_window(Program& to);

 protected:
  /// Line of the block that ends the program; 0 if it was not read yet.
  virtual int end_line() const = 0;

 private:
  /// Continues behind the first `read` bytes of a new window.
  virtual void resume_behind(std::size_t read) = 0;

  const ReadOptions options_;
  const Dialect& dialect_;
  const Outline outline_;
  Program program_;
};

/// The reader of the dialect. `outline` describes the text, or the text of which it is a correction.
std::unique_ptr<BlockReader> make_reader(const std::string& file, const ReadOptions& options,
                                         const Dialect& dialect, Outline outline);

}  // namespace counterflex
