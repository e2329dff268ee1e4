#include "counterflex/program/rewrite.hpp"

#include <cassert>

#include "program/held_position.hpp"
#include "program/klartext_lex.hpp"
#include "program/klartext_rewrite.hpp"
#include "program/rewrite_block.hpp"

namespace counterflex {
namespace {

/// Behind the line of '%' and that of the program's number, whichever comes last; else the beginning.
std::size_t header_position(const Program& program) {
  const Dialect& dialect = *find_dialect(program.dialect);
  std::size_t position = 0;
  bool opened = false;
  Block block;
  while (next_line(program.text, block)) {
    lex(program.text, program.file, dialect, block);
    const bool number = is_program_number(block);
    if ((block.percent && opened) || (!block.words.empty() && !number)) break;
    opened = opened || block.percent;
    if (block.percent || number) position = block.line_end.end;
    if (number) break;
  }
  return position;
}

/// A comment's text in upper-case ASCII without comment characters.
std::string comment_text(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    const bool printable = c >= 0x20 && c < 0x7f && c != comment_open && c != comment_close;
    const char kept = printable ? c : ' ';
    safe += kept >= 'a' && kept <= 'z' ? static_cast<char>(kept - 'a' + 'A') : kept;
  }
  return safe;
}

std::string header_text(const Program& program, const ProgramStyle& style, std::size_t position,
                        const WriteOptions& options) {
  std::string text;
  if (!options.header.empty() && position > 0 && program.text[position - 1] != '\n') text += style.line_end;
  for (const std::string& line : options.header)
    text += comment_open + comment_text(line) + comment_close + style.line_end;
  return text;
}

}  // namespace

Rewritten rewrite(const Program& program, const std::vector<MoveEdit>& edits, const WriteOptions& options) {
  if (program.dialect == klartext_name) return rewrite_klartext(program, edits, options);
  const ProgramStyle style = style_of(program);
  const std::size_t header = header_position(program);
  Rewritten out;
  out.text.reserve(program.text.size() + program.text.size() / 8);
  out.text.append(program.text, 0, header).append(header_text(program, style, header, options));

  HeldPosition held{};
  std::size_t copied = header;
  std::size_t next = 0;
  for (const MoveEdit& edit : edits) {
    assert(edit.move >= next && edit.move < program.moves.size());
    for (; next < edit.move; ++next) held = held_after_original(program.moves[next], held);
    const Span block = program.moves[edit.move].block;
    out.text.append(program.text, copied, block.begin - copied);
    const std::size_t inserted = out.inserted_blocks;
    rewrite_block(program, style, edit, options, held, out);
    out.blocks_of_edit.push_back(out.inserted_blocks - inserted);
    copied = block.end;
    ++next;
  }
  out.text.append(program.text, copied);
  return out;
}

}  // namespace counterflex
