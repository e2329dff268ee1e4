#include "program/program_writer.hpp"

#include "program/dialect.hpp"
#include "program/klartext/write/writer.hpp"
#include "program/robot/apt/writer.hpp"
#include "program/robot/fanuc/writer.hpp"
#include "program/robot/kuka/writer.hpp"
#include "program/robot/rapid/writer.hpp"
#include "program/robot/ur/writer.hpp"
#include "program/robot/yaskawa/writer.hpp"
#include "program/write/gcode_writer.hpp"

namespace counterflex {

std::unique_ptr<ProgramWriter> make_writer(const Program& window, const WriteOptions& options) {
  if (window.dialect == klartext_name) return std::make_unique<KlartextWriter>(window, options);
  if (window.dialect == kuka_name) return std::make_unique<KukaWriter>(window, options);
  if (window.dialect == abb_name) return std::make_unique<RapidWriter>(window, options);
  if (window.dialect == ur_name) return std::make_unique<UrWriter>(window, options);
  if (window.dialect == apt_name) return std::make_unique<AptWriter>(window, options);
  if (window.dialect == tp_name) return std::make_unique<FanucWriter>(window, options);
  if (window.dialect == yaskawa_name) return std::make_unique<YaskawaWriter>(window, options);
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
