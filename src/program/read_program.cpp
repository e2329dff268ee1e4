#include "counterflex/program/read_program.hpp"

#include <algorithm>

#include "program/expand.hpp"
#include "program/klartext_read.hpp"
#include "program/line_reader.hpp"

namespace counterflex {
namespace {

/// "COUNTERFLEX 1", alone or followed by more words.
bool is_mark(std::string_view comment) {
  constexpr std::string_view mark = "COUNTERFLEX 1";
  comment.remove_prefix(std::min(comment.find_first_not_of(" \t"), comment.size()));
  return comment.starts_with(mark) && (comment.size() == mark.size() || comment[mark.size()] == ' ');
}

}  // namespace

Program read_program(std::string text, const std::string& file, const ReadOptions& options) {
  const Dialect& dialect = choose_dialect(text, file, options);
  const bool klartext = dialect.name == klartext_name;
  Expansion expansion;
  if (options.expand_subprograms && !klartext) expansion = expand_subprograms(text, file, dialect);
  LineReader lines(file, options, dialect, klartext ? Outline{} : outline_of(text, dialect));
  Program& program = lines.program();
  program.text = std::move(text);
  program.expansion = std::move(expansion);
  if (klartext)
    read_klartext(program, options, axes_of_tool_change(dialect, options));
  else
    lines.read_all();
  if (options.expand_subprograms) remark_expansion(program);
  return std::move(program);
}

bool is_corrected(const Program& program) {
  if (program.dialect == klartext_name) return is_corrected_klartext(program.text);
  const Dialect& dialect = *find_dialect(program.dialect);
  Block block;
  for (int percents = 0; next_line(program.text, block);) {
    lex(program.text, program.file, dialect, block);
    if (block.percent && ++percents == 2) return false;
    for (const Span comment : block.comments)
      if (is_mark(part(program.text, comment))) return true;
    if (!block.words.empty() && !begins_with_program_number(block)) return false;
  }
  return false;
}

}  // namespace counterflex
