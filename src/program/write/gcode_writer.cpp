#include "program/write/gcode_writer.hpp"

#include <cassert>

#include "program/expand/expand.hpp"
#include "program/guard/guard_text.hpp"
#include "program/text/scanner.hpp"
#include "program/write/block.hpp"
#include "program/write/plain.hpp"

namespace counterflex {
namespace {

/// Position behind the lines of '%' and of the program number; else the beginning, behind the UTF-8 byte
/// order mark and the rest of its line if that has no words.
std::size_t header_position(const Program& program) {
  const Dialect& dialect = *find_dialect(program.dialect);
  std::size_t position = byte_order_mark(program.text);
  bool opened = false;
  Block block;
  while (next_line(program.text, block)) {
    lex(program.text, program.file, dialect, block);
    const bool number = begins_with_program_number(block) || (block.part_name && !block.percent);
    if (!program.moves.empty() && block.span.begin >= program.moves.front().block.begin) break;
    if ((block.percent && opened) || (!block.words.empty() && !number)) break;
    opened = opened || block.percent;
    const bool path =
        part(program.text, block.span).starts_with(";$PATH");  // must follow the '%' of a Sinumerik
    const bool marked = block.text_line == 1 && position > 0 && block.words.empty();
    if (block.percent || number || marked || (path && opened)) position = block.line_end.end;
    if (number) break;
  }
  return position;
}

/// The text of a comment in upper-case ASCII without comment characters.
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
  if (!options.header.empty() && position > byte_order_mark(program.text) &&
      program.text[position - 1] != '\n')
    text += style.line_end;
  if (find_dialect(program.dialect)->sinumerik_words) {
    for (const std::string& line : options.header)
      text.append(1, ';').append(comment_text(line)).append(style.line_end);
    return text;
  }
  for (const std::string& line : options.header)
    text += comment_open + comment_text(line) + comment_close + style.line_end;
  return text;
}

/// The text being written: `out` has everything before byte `copied` of the input.
struct Writing {
  const Program& program;
  const ProgramStyle& style;
  TextState& state;
  const PlainRewriting common;
  const Guard* guard = nullptr;  ///< to be written in this window
  std::size_t guarded = 0;       ///< the move before which it is written
  std::size_t copied = 0;
  Rewritten out{};
};

/// After a motion word or the end of a program before byte `end`, the modal motion is known.
void find_motion_until(std::size_t end, Writing& w) {
  const Dialect& dialect = *find_dialect(w.program.dialect);
  Block block;
  block.line_end.end = w.copied;
  while (w.state.restate_motion && block.line_end.end < end && next_line(w.program.text, block)) {
    if (is_unused(w.program.expansion, block.span.begin)) continue;
    lex(w.program.text, w.program.file, dialect, block);
    if (block.span.begin < end && ends_motion(block, dialect)) w.state.restate_motion.reset();
  }
}

/// Copies the text before byte `end`, which has no moves.
void copy_until(std::size_t end, Writing& w) {
  if (w.state.restate_motion) find_motion_until(end, w);
  w.out.text.append(w.program.text, w.copied, end - w.copied);
  w.copied = end;
}

/// The next move to write, and the position in the text before it.
const Move& come_to(std::size_t index, Writing& w) {
  const Move& move = w.program.moves[index];
  if (w.guard != nullptr && index == w.guarded) {
    copy_until(move.block.begin, w);
    w.out.text += guard_text(w.program.dialect, *w.guard, w.style.line_end);
  }
  const Move* last = move_before(w.program, index);
  if (last != nullptr && last->end_mm != move.start_mm)
    w.state.position = text_position_between(*last, move, w.state.position);
  for (std::size_t axis = 0; last == nullptr && axis < 3; ++axis)  // G92 has given the first position
    if (move.known_start[axis]) w.state.position[axis] = component(move.start_mm, axis);
  return move;
}

void keep_move(std::size_t index, const WriteOptions& options, Writing& w) {
  const Move& move = come_to(index, w);
  if (!has_call(move, 0, w.state)) {
    copy_until(move.block.begin, w);
    rewrite_block(w.program, w.style, {.move = index, .end_mm = move.end_mm}, options, w.state, w.out);
    w.copied = move.block.end;
    return;
  }
  if (w.state.restate_motion) copy_until(move.block.begin, w);
  if (!w.state.restate_motion) return keep_block(move, w.state);
  copy_block(w.program, w.style, move, w.state, w.out);
  w.copied = move.block.end;
}

void apply(const MoveEdit& edit, const WriteOptions& options, Writing& w) {
  const Span block = come_to(edit.move, w).block;
  if (!w.state.restate_motion && append_plain_block(w.common, edit, w.copied, w.state.position, w.out)) {
    w.out.blocks_of_edit.push_back(0);
    w.copied = block.end;
    return;
  }
  copy_until(block.begin, w);
  const std::size_t inserted = w.out.inserted_blocks;
  rewrite_block(w.program, w.style, edit, options, w.state, w.out);
  w.out.blocks_of_edit.push_back(w.out.inserted_blocks - inserted);
  w.copied = block.end;
}

/// The header follows the lines that must be first in a program.
void begin(const WriteOptions& options, Writing& w) {
  w.copied = header_position(w.program);
  w.out.text.append(w.program.text, 0, w.copied).append(header_text(w.program, w.style, w.copied, options));
}

}  // namespace

Rewritten GcodeWriter::write(const Program& window, const std::vector<MoveEdit>& edits) {
  Writing w{window, style_, text_, {window, options_}};
  w.out.text.reserve(window.text.size() + window.text.size() / 8);
  w.out.blocks_of_edit.reserve(edits.size());
  if (!begun_) begin(options_, w);
  begun_ = true;
  if (const Move* cut = options_.guard && !guarded_ ? first_cut(window) : nullptr; cut != nullptr) {
    w.guard = &*options_.guard;
    w.guarded = static_cast<std::size_t>(cut - window.moves.data());
    guarded_ = true;
  }
  std::size_t next = 0;
  for (const MoveEdit& edit : edits) {
    assert(edit.move >= next && edit.move < window.moves.size());
    for (; next < edit.move; ++next) keep_move(next, options_, w);
    apply(edit, options_, w);
    ++next;
  }
  for (; next < window.moves.size(); ++next) keep_move(next, options_, w);
  copy_until(window.text.size(), w);
  return std::move(w.out);
}

}  // namespace counterflex
