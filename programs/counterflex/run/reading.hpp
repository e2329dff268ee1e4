#pragma once
/// Reads a whole program, once or more, before it is solved.
#include <array>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "run/inputs.hpp"

namespace counterflex::cli {

/// The contents of a program that was read without errors.
struct ProgramScan {
  Overview program;
  bool is_corrected = false;  ///< the program carries the header of a corrected one
};

/// Reads the program to its end once and computes its hash. Calls `also` for each window while the next ones
/// are read. Throws `InputError`.
ProgramScan scan_program(const Options& options, ProgramFile& file, const ReadOptions& read,
                         const std::function<void(const Program&)>& also = {});

/// A program whose path is built window by window. Keeps references to all arguments.
struct PathInput {
  FileReader& bytes;
  const std::string& name;
  const ReadOptions& read;
  const std::vector<WorkFrame>& frames;
  const std::array<bool, 3>& ignored;  ///< program axes that no target uses
};

/// Checks the forces against the whole program before any of it is solved. Throws `InputError`.
void settle_forces(const PathInput& input, ForceSource& source);

/// Forces that are read before the program and resolved during its first pass, if they depend only on its
/// moves. Keeps errors of the forces until the program has been read: errors of the program come first.
class ForcePrescan {
 public:
  /// Reads the files of `options` into `input`, which outlives this.
  ForcePrescan(const Options& options, const Machine& machine, ForceInput& input);

  /// The next window of the program.
  void add(const Program& window);

  /// Throws the errors of the files (`InputError`).
  void refuse_unread() const;

  /// Calls `settle_forces` if the forces were not resolved during the first pass. Throws as it.
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
