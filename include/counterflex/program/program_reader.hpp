#pragma once
/// Reads programs of any size in windows: runs of whole lines, each a `Program` of its own.
#include <memory>
#include <string>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/program/read_program.hpp"

namespace counterflex {

/// The size of a window: a rapid counts as 1, a line as 1 for each 5 mm that it begins (64 at most), an arc as 16 for
/// each turn that it begins. These are about as many as the places at which it is solved.
std::size_t window_size(const Program& window);

/// The least size after which a window ends.
inline constexpr std::size_t window_moves = 2048;
/// Windows without an end.
inline constexpr std::size_t whole_program = static_cast<std::size_t>(-1);

/// A program of a file, window by window. A window ends before a move along X or Y, or an arc, whose start is
/// known in all axes, outside of contours, cycles, bodies and doubts, so that it can be corrected without
/// looking back; it grows until there is such a place, or to twice its size until there is such a move along Z
/// behind others. Its moves and all that has been found are those of `read_program`. A program whose subprograms
/// are expanded, and Klartext whose polar blocks cannot all be followed, is one window, whatever its size.
class ProgramReader {
 public:
  /// `bytes` is read from its beginning, where its dialect needs it once to see the program as a whole, then
  /// window by window; it outlives the reader. `least_moves` of each window but the last. Throws `InputError`
  /// as `read_program` does, where the dialect is not known.
  ProgramReader(FileReader& bytes, const std::string& file, const ReadOptions& options,
                std::size_t least_moves = window_moves);
  ~ProgramReader();
  ProgramReader(ProgramReader&&) noexcept;

  /// Reads the next window; false, and an empty one, when the program has been given out. Throws
  /// `InputError` as `read_program` does.
  bool next();

  /// Makes the window longer, to the next place where it may end; false when there is nothing more.
  bool extend();

  const Program& window() const;
  Program& window();

  /// Gives the window away, without `remarks` and `path_tolerances`: it stands on its own and stays as it is
  /// while others are read. What `to` held is used again.
  void take_window(Program& to);

 private:
  friend class TextReader;
  struct State;
  std::unique_ptr<State> state_;
};

/// A program whose text comes in portions of whole lines, as it is written.
class TextReader {
 public:
  /// Reads in the way in which `original` is read, of which the text is a correction.
  TextReader(const ProgramReader& original);
  /// For a program of one portion, the correction of `original`.
  TextReader(const Program& original, const ReadOptions& options);
  ~TextReader();
  TextReader(TextReader&&) noexcept;

  /// The window of the next portion, until the next call. Throws `InputError` as `read_program` does.
  const Program& read(std::string text);

  /// Gives that window away, as a ProgramReader does.
  void take_window(Program& to);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace counterflex
