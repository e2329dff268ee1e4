#include "counterflex/program/read_program.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/files/large_pages.hpp"
#include "program/interpret.hpp"
#include "program/klartext_read.hpp"
#include "program/remarks.hpp"

namespace counterflex {
namespace {

const Dialect& choose_dialect(const std::string& text, const std::string& file, const ReadOptions& options) {
  if (options.dialect == "auto") return detect_dialect(text);
  const Dialect* dialect = find_dialect(options.dialect);
  if (dialect == nullptr)
    throw InputError(Exit::usage, {file},
                     fmt::format("dialect '{}' is not known: {} are", options.dialect, dialect_names()));
  return *dialect;
}

std::array<bool, 3> tool_change_axes(const Dialect& dialect, const ReadOptions& options) {
  std::array<bool, 3> axes{};
  axes.fill(!options.tool_change_moves && dialect.tool_change_moves_axes);
  if (!options.tool_change_moves) return axes;
  for (const char letter : *options.tool_change_moves)
    if (letter >= 'X' && letter <= 'Z') axes[static_cast<std::size_t>(letter - 'X')] = true;
  return axes;
}

/// "COUNTERFLEX 1", alone or followed by more words.
bool is_mark(std::string_view comment) {
  constexpr std::string_view mark = "COUNTERFLEX 1";
  comment.remove_prefix(std::min(comment.find_first_not_of(" \t"), comment.size()));
  return comment.starts_with(mark) && (comment.size() == mark.size() || comment[mark.size()] == ' ');
}

/// For a move a line: growing step by step would copy every move several times.
void make_room(Program& program) {
  const std::string& text = program.text;
  program.moves.reserve(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1);
  prefer_large_pages(program.moves.data(), program.moves.capacity() * sizeof(Move));
}

/// A second program behind the end of the first: nobody corrects it.
void remark_rest(Program& program, const Block& last) {
  if (program.text.find_first_not_of("% \t\r\n", last.line_end.end) != std::string::npos)
    add_remark(program, last.line, "what stands behind the end of the program stays as it is");
}

}  // namespace

Program read_program(std::string text, const std::string& file, const ReadOptions& options) {
  const Dialect& dialect = choose_dialect(text, file, options);
  Program program;
  program.file = file;
  program.text = std::move(text);
  program.dialect = dialect.name;
  program.integer_words = options.integer_words;

  if (dialect.name == klartext_name) {
    read_klartext(program, options, tool_change_axes(dialect, options));
    return program;
  }

  make_room(program);
  Reading reading{dialect, options, tool_change_axes(dialect, options), program};
  reading.state.unit = options.unit;
  reading.outline = outline_of(program.text, dialect);
  reading.body.jumps = reading.outline.jumps;
  Block block;
  bool opened = false;
  while (!reading.ended && next_line(program.text, block)) {
    lex(program.text, file, dialect, block);
    if (block.percent && (opened || program.block_count > 0)) break;
    opened = opened || block.percent;
    interpret(block, reading);
  }
  if (reading.ended) remark_rest(program, block);
  return program;
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
    if (!block.words.empty() && !is_program_number(block)) return false;
  }
  return false;
}

}  // namespace counterflex
