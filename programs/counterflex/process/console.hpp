#pragma once
/// Standard error: warnings, progress and errors. Results go to standard output, not through here.
#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/compensation/options.hpp"

namespace counterflex::cli {

/// Receives diagnostics and progress of a run without a terminal.
struct ConsoleListener {
  std::function<void(std::string_view diagnostic)> error{};    ///< instead of standard error
  std::function<void(std::string_view diagnostic)> warning{};  ///< likewise, of all warnings
  std::function<void(int line, int lines)> solving{};          ///< is at `line` of `lines`
  std::function<void(std::size_t waypoints)> solved{};  ///< number of waypoints solved since the last call
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

  /// From now on, lines of the program `name` are named in the file in which they are. Its files are joined;
  /// `first` has the first line of each in the joined text.
  void name_lines(const std::string& name, const std::vector<std::string>& files,
                  const std::vector<int>& first);

  /// "file:line: warning: what", without the line if it is 0. A warning of the same text is printed once. At
  /// most 20 for each file; `finish_warnings` prints the number of others.
  void warning(const std::string& file, int line, std::string_view what);
  void more_warnings(const std::string& file, std::size_t count);  ///< counted, not shown
  void finish_warnings();  ///< called before a result; clears the line of progress, too

  /// Printed with --verbose only.
  void detail(std::string_view what);

  /// A text of several lines, unless --quiet.
  void note(std::string_view text);

  /// The current activity, on one line that the next output replaces. Only on a terminal. While the terminal
  /// does not accept text, as when it is stopped, the line is dropped: progress never blocks a run.
  void progress(std::string_view what);
  void progress_line(std::string_view line);  ///< the same, unchanged

  /// Progress of a run through its program: a bar with percentage, rate and time left. `solved` may be called
  /// by another thread.
  void solving(int line, int lines);
  void solved(std::size_t waypoints);

  /// A diagnostic as `InputError::what()` returns it.
  void error(std::string_view diagnostic);

  /// Whether one terminal shows standard output and standard error.
  bool is_one_terminal() const { return one_terminal_; }

  /// Whether text on standard output may hold colours.
  bool colour_out() const { return colour_out_; }

  /// And text on standard error.
  bool colour_error() const { return colour_; }

  /// Whether standard output, or standard error, is a terminal that shows UTF-8.
  bool marks_out() const { return marks_out_; }
  bool marks_error() const { return marks_error_; }

 private:
  void erase_progress();
  std::string with_named_line(std::string_view diagnostic) const;

  struct JoinedFiles {
    std::vector<std::string> files;
    std::vector<int> first;
  };

  std::map<std::string, JoinedFiles, std::less<>> joined_;  ///< by the name of the program
  ConsoleListener listener_;
  bool quiet_, verbose_, terminal_, one_terminal_, colour_, colour_out_, marks_out_, marks_error_;
  bool showing_progress_ = false;
  std::atomic<std::size_t> waypoints_ = 0;  ///< solved
  std::optional<std::chrono::steady_clock::time_point> begun_;
  std::chrono::steady_clock::time_point shown_at_;
  std::map<std::string, std::size_t> warnings_;
  std::set<std::string, std::less<>> texts_;  ///< of warnings, with their file and line
};

/// "file:line:1: error: what"; without a line "file: error: what".
std::string located(const std::string& file, const Failure& failure);

/// A diagnostic with its file, which it does not name itself.
std::string with_file(const std::string& diagnostic, const std::string& file);

/// How diagnostics name a file: "-" as "<stdin>".
std::string shown_name(const std::string& path);

}  // namespace counterflex::cli
