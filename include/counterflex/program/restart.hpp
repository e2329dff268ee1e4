#pragma once
/// The lines at which a control may begin a program again.
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace counterflex {

/// A block that changes the tool.
struct RestartLine {
  int line = 0;
  long tool = 0;
  std::string text;  ///< of the line
  /// What the blocks behind it take from those before it, in words; empty: nothing, the program may begin
  /// here.
  std::string missing;
};

struct RestartLines {
  std::vector<RestartLine> lines;  ///< in order
  /// Why no line is proven, for a program as a whole; empty: see `lines`.
  std::string why_none;
};

/// Finds the restart lines of a program in G-code while its text arrives. A tool change is proven if every
/// state that the program has set before it is set again behind it, before the state acts: unit, distance,
/// plane, work offset, cutter compensation, path mode and motion before the first word of an axis, the tool
/// length before the first Z, and feed, speed, spindle, coolant and a position in each axis before the first
/// feed move. Behind a state that is not followed (G10, G52, G68, G92 and their like) no line is proven. A
/// program with variables, jumps, loops or subprograms has no proven line, and neither has one in another
/// language.
class RestartScan {
 public:
  explicit RestartScan(const std::string& dialect);
  ~RestartScan();
  RestartScan(RestartScan&&) noexcept;

  /// The next whole lines.
  void add(std::string_view lines);

  RestartLines finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace counterflex
