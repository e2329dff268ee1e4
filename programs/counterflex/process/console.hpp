#pragma once
/// Standard error: warnings, what is being done, and errors. Results go to standard output, not through here.
#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/compensation/options.hpp"

namespace counterflex::cli {

/// Hears what a run says of itself, where it has no terminal of its own.
struct ConsoleListener {
  std::function<void(std::string_view diagnostic)> error{};  ///< instead of standard error
  std::function<void(int line, int lines)> solving{};        ///< has come to this line of so many
  std::function<void(std::size_t waypoints)> solved{};       ///< so many more
};

struct Loudness {
  bool quiet = false;    ///< no warnings, no notes, no progress
  bool verbose = false;  ///< details, unless `quiet`
};

class Console {
 public:
  explicit Console(Loudness loudness = {}, ConsoleListener listener = {});
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// "file:line: warning: what"; at most 20 of a file, `finish_warnings` counts the others. Line 0: none.
  void warning(const std::string& file, int line, std::string_view what);
  /// Whether the person at the terminal, who sees standard output too, has read this warning already.
  bool has_shown(std::string_view what) const { return shown_.count(what) > 0; }
  void more_warnings(const std::string& file, std::size_t count);  ///< that nobody needs to see
  void finish_warnings();  ///< the last word before a result: it clears the line of progress, too

  /// Told with --verbose only.
  void detail(std::string_view what);

  /// A text of several lines, unless --quiet.
  void note(std::string_view text);

  /// What the run does at the moment, on one line that the next output replaces. Only on a terminal; while
  /// the terminal does not take text, as when it is stopped, the line is dropped: progress never blocks a
  /// run.
  void progress(std::string_view what);
  void progress_line(std::string_view line);  ///< the same, as it is

  /// Progress of a run through its program.
  void solving(int line, int lines);
  void solved(std::size_t waypoints) const;

  /// A diagnostic as `InputError::what()` has it.
  void error(std::string_view diagnostic);

  /// Whether text on standard output may hold colours.
  bool colour_out() const { return colour_out_; }

  /// And text on standard error.
  bool colour_error() const { return colour_; }

  /// Whether standard output, or standard error, is a terminal that shows UTF-8.
  bool marks_out() const { return marks_out_; }
  bool marks_error() const { return marks_error_; }

 private:
  void erase_progress();

  ConsoleListener listener_;
  bool quiet_, verbose_, terminal_, colour_, colour_out_, marks_out_, marks_error_;
  bool showing_progress_ = false;
  std::map<std::string, std::size_t> warnings_;
  std::set<std::string, std::less<>> shown_;  ///< where both streams are terminals
};

/// "file:line:1: error: what"; without a line "file: error: what".
std::string located(const std::string& file, const Failure& failure);

/// A diagnostic that names no file, with the one that it is about.
std::string with_file(const std::string& diagnostic, const std::string& file);

/// How diagnostics name a file: "-" as "<stdin>".
std::string shown_name(const std::string& path);

}  // namespace counterflex::cli
