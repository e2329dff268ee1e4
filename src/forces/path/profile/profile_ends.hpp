#pragma once
/// Checks the ends of a profile against the program, window by window.
#include <optional>
#include <string>

#include "counterflex/forces/forces.hpp"
#include "forces/path/profile/alignment.hpp"

namespace counterflex {

/// The extent of a program, by every key.
struct ProgramEnds {
  long last_block_number = 0;
  long newlines = 0, last_line = 0;  ///< lines; of the last move
  long file_lines = 0;               ///< if calls were expanded
  bool ends_in_line = false;         ///< the text ends without a line end
  PathEnd path;

  void add(const Program& window, const Toolpath& of_window);

  /// The largest value of a key.
  double last(ForceKey key) const;
};

/// First and last key of the cutting moves.
class ProfileEnds {
 public:
  explicit ProfileEnds(const ForceProfile& profile) : profile_(profile) {}

  void add(const KeySpan& keys, const Segment& cut);

  /// Throws `InputError` (ErrorKind::machine_or_force) at a row whose key is beyond the end of the program.
  void refuse_rows_beyond(const ProgramEnds& program) const;

  /// Throws if the profile is the only rule and leaves a cutting move without a force: if its first row is
  /// after the first cutting move, or if it is linear and its last row is before the end of the last.
  void refuse_missing_ends(const ProgramEnds& program) const;

 private:
  struct Cut {
    double key = 0;
    int line = 0;
  };
  const ForceProfile& profile_;
  std::optional<Cut> first_, last_;  ///< of the cutting moves: key where the first begins and the last ends
};

}  // namespace counterflex
