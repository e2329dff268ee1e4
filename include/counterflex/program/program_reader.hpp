#pragma once
/// Reads programs of any size in windows. A window is a run of whole lines, and a `Program` of its own.
#include <memory>
#include <string>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/program/read_program.hpp"

namespace counterflex {

/// The size of a window, about the number of places at which it is solved. A rapid counts 1, a line 1 for
/// each started 5 mm (at most 64), an arc 16 for each started turn.
std::size_t window_size(const Program& window);

/// Smallest size at which a window ends. 2048: the same time, and 10 MB more for two threads with reports.
inline constexpr std::size_t window_moves = 1024;
/// Reads the whole program as one window.
inline constexpr std::size_t whole_program = static_cast<std::size_t>(-1);

/// A program of a file, read window by window. A window ends before a move along X or Y, or before an arc, if
/// the move can be corrected without the moves before it: its start is known in all axes, it is outside of
/// contours, cycles and bodies, and all modal states are known. A window grows until there is such a move; at
/// twice its size it may also end before such a move along Z that follows others. The moves of all windows
/// are those of `read_program`. A program whose subprograms are expanded is one window, and so is Klartext
/// with polar blocks that cannot be followed.
class ProgramReader {
 public:
  /// Reads `bytes` from the beginning: once to find what depends on the whole program, if the dialect needs
  /// it, then window by window. `bytes` must outlive the reader. Each window but the last has a size of at
  /// least `least_moves`. Throws `InputError` as `read_program` does if the dialect is unknown.
  ProgramReader(FileReader& bytes, const std::string& file, const ReadOptions& options,
                std::size_t least_moves = window_moves);
  ~ProgramReader();
  ProgramReader(ProgramReader&&) noexcept;

  /// Reads the next window. Its least size is divided by `part`, at least 1. At the end of the program,
  /// returns false and sets an empty window. Throws `InputError` as `read_program` does.
  bool next(std::size_t part = 1);

  /// Extends the window to the next place at which it may end. False at the end of the program.
  bool extend();

  const Program& window() const;
  Program& window();

  /// Moves the window into `to`, without `remarks` and `path_tolerances`. It does not change while other
  /// windows are read. Reuses the memory of `to`.
  void take_window(Program& to);

 private:
  friend class TextReader;
  struct State;
  std::unique_ptr<State> state_;
};

/// Reads a program whose text arrives in portions of whole lines.
class TextReader {
 public:
  /// Reads with the options and states of `original`. The text is a correction of it.
  TextReader(const ProgramReader& original);
  /// For a program of one portion, the correction of `original`.
  TextReader(const Program& original, const ReadOptions& options);
  ~TextReader();
  TextReader(TextReader&&) noexcept;

  /// The window of the next portion, valid until the next call. Throws `InputError` as `read_program` does.
  const Program& read(std::string text);

  /// Moves that window into `to`, as in ProgramReader.
  void take_window(Program& to);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace counterflex
