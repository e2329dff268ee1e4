#pragma once
/// Passes over a whole program before anything is made of it.
#include <array>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "run/inputs.hpp"

namespace counterflex::cli {

/// What a program holds, and that it can be read.
struct ProgramLook {
  Overview program;
  bool is_corrected = false;  ///< the program carries the header of a corrected one
};

/// Reads the program to its end once, and notes its hash; `also` looks at its windows, too, while others are
/// read. Throws
/// `InputError`.
ProgramLook look_through(const Options& options, ProgramFile& file, const ReadOptions& read,
                         const Machine* machine, const std::function<void(const Program&)>& also = {});

/// A program whose path is built window by window. Borrows all.
struct PathInput {
  FileReader& bytes;
  const std::string& name;
  const ReadOptions& read;
  const std::vector<WorkFrame>& frames;
  const std::array<bool, 3>& ignored;  ///< program axes that no target needs
};

/// Forces have to fit the whole program before any of it is solved. Throws `InputError`.
void settle_forces(const PathInput& input, ForceSource& source);

/// Forces that are read before the program and settled while it is looked through, where they ask for no more
/// of a path than its moves. What is wrong with them is kept until its turn comes: after the program.
class EarlyForces {
 public:
  /// Reads the files of `options` into `input`, which outlives this.
  EarlyForces(const Options& options, const Machine& machine, ForceInput& input);

  /// The next window of the program.
  void add(const Program& window);

  /// Throws what is wrong with the files (InputError).
  void refuse_unread() const;

  /// Throws as `settle_forces`, which it does where nothing has been settled on the way.
  void settle(const PathInput& input);

 private:
  ForceSource& source_;
  std::exception_ptr unread_, unsettled_;
  std::optional<ForceCover> cover_;
  PathEnd end_;

  template <typename Work>
  void keep_error(const Work& work);
};

}  // namespace counterflex::cli
