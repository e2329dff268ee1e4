#pragma once
/// Writes the windows of one program in its language.
#include <memory>
#include <vector>

#include "counterflex/program/rewrite.hpp"

namespace counterflex {

class ProgramWriter {
 public:
  virtual ~ProgramWriter() = default;

  /// As `Rewriter::write`. The text of the first window includes the header.
  virtual Rewritten write(const Program& window, const std::vector<MoveEdit>& edits) = 0;
};

/// The writer of the program that begins with `window`.
std::unique_ptr<ProgramWriter> make_writer(const Program& window, const WriteOptions& options);

}  // namespace counterflex
