#pragma once
/// Passes over a whole program before anything is made of it.
#include <array>
#include <string>
#include <vector>

#include "inputs.hpp"

namespace counterflex::cli {

/// What a program holds, and that it can be read.
struct ProgramLook {
  Overview program;
  bool is_corrected = false;  ///< the program carries the header of a corrected one
};

/// Reads the program to its end once, and notes its hash. Throws `InputError`.
ProgramLook look_through(const Options& options, ProgramFile& file, const ReadOptions& read,
                         const Machine* machine);

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

}  // namespace counterflex::cli
