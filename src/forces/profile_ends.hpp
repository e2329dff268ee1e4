#pragma once
/// Whether the ends of a profile fit the program, gathered window by window.
#include <optional>
#include <string>

#include "counterflex/forces/forces.hpp"
#include "forces/alignment.hpp"

namespace counterflex {

/// How far a program goes, by every key.
struct ProgramEnds {
  long last_block_number = 0;
  long newlines = 0, last_line = 0;  ///< lines; of the last move
  long file_lines = 0;               ///< where calls were expanded
  bool ends_in_line = false;         ///< the text ends without a line end
  PathEnd path;

  void add(const Program& window, const Toolpath& of_window);

  /// The greatest value that a key has.
  double last(ForceKey key) const;
};

/// Where the cutting moves begin and end by a profile's key.
class ProfileEnds {
 public:
  explicit ProfileEnds(const ForceProfile& profile) : profile_(profile) {}

  void add(const KeySpan& keys, const Segment& cut);

  /// Throws `InputError` (Exit::machine_or_force) naming the row whose key lies beyond the program.
  void refuse_rows_beyond(const ProgramEnds& program) const;

  /// Throws where the profile, being the only rule, leaves a cutting move without a force: at the first row
  /// after the first cutting move, or the last of a linear profile before the last.
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
