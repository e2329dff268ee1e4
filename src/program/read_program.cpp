#include "counterflex/program/read_program.hpp"

#include "program/block_reader.hpp"
#include "program/detect/choose_dialect.hpp"
#include "program/expand/expand.hpp"
#include "program/klartext/expand.hpp"
#include "program/klartext/reader.hpp"
#include "program/robot/apt/lex.hpp"
#include "program/robot/fanuc/reader.hpp"
#include "program/robot/kuka/lex.hpp"
#include "program/robot/rapid/lex.hpp"
#include "program/robot/reader.hpp"
#include "program/robot/ur/lex.hpp"
#include "program/robot/yaskawa/reader.hpp"
#include "program/text/operation.hpp"

namespace counterflex {

Program read_program(std::string text, const std::string& file, const ReadOptions& options) {
  const Dialect& dialect = choose_dialect(text, file, options);
  Expansion expansion;
  if (options.expand_subprograms)
    expansion =
        dialect.name == klartext_name ? expand_klartext(text, file) : expand_subprograms(text, file, dialect);
  Outline outline = outline_of(text, dialect, options.harmless_calls);
  // The program itself never reaches a GOTO that remains after the execution of jumps.
  if (expansion.in_order) outline.jumps = false;
  const auto reader = make_reader(file, options, dialect, std::move(outline));
  Program& program = reader->program();
  program.text = std::move(text);
  program.expansion = std::move(expansion);
  reader->read_all();
  if (options.expand_subprograms) remark_expansion(program);
  return std::move(program);
}

bool is_corrected(const Program& program) {
  if (program.dialect == klartext_name) return is_corrected_klartext(program.text);
  if (program.dialect == kuka_name) return is_corrected_robot_program(program.text, krl_comment);
  if (program.dialect == abb_name) return is_corrected_robot_program(program.text, rapid_comment);
  if (program.dialect == ur_name) return is_corrected_robot_program(program.text, ur_comment);
  if (program.dialect == apt_name) return is_corrected_robot_program(program.text, apt_comment);
  if (program.dialect == tp_name) return is_corrected_tp_program(program.text);
  if (program.dialect == yaskawa_name) return is_corrected_job(program.text);
  const Dialect& dialect = *find_dialect(program.dialect);
  Block block;
  for (int percents = 0; next_line(program.text, block);) {
    lex(program.text, program.file, dialect, block);
    if (block.percent && ++percents == 2) return false;
    for (const Span comment : block.comments)
      if (is_header_comment(part(program.text, comment))) return true;
    if (!block.words.empty() && !begins_with_program_number(block)) return false;
  }
  return false;
}

}  // namespace counterflex
