#include "program/program_writer.hpp"

#include "program/dialect.hpp"
#include "program/klartext/write/writer.hpp"
#include "program/write/gcode_writer.hpp"

namespace counterflex {

std::unique_ptr<ProgramWriter> make_writer(const Program& window, const WriteOptions& options) {
  if (window.dialect == klartext_name) return std::make_unique<KlartextWriter>(window, options);
  return std::make_unique<GcodeWriter>(window, options);
}

Rewriter::Rewriter(const WriteOptions& options) : options_(options) {}
Rewriter::~Rewriter() = default;
Rewriter::Rewriter(Rewriter&&) noexcept = default;

Rewritten Rewriter::write(const Program& window, const std::vector<MoveEdit>& edits) {
  if (!writer_) writer_ = make_writer(window, options_);
  return writer_->write(window, edits);
}

Rewritten rewrite(const Program& program, const std::vector<MoveEdit>& edits, const WriteOptions& options) {
  return Rewriter(options).write(program, edits);
}

}  // namespace counterflex
