#include "program/klartext_rewrite.hpp"

#include <algorithm>
#include <cassert>

#include "program/held_position.hpp"
#include "program/klartext_block.hpp"
#include "program/lex.hpp"

namespace counterflex {
namespace {

/// Behind BEGIN PGM, else the beginning.
std::size_t klartext_header_position(const Program& program) {
  KlartextBlock block;
  while (next_klartext_block(program.text, block)) {
    if (block.parts.empty()) continue;
    return block.head == "BEGIN" ? block.line_end.end : 0;
  }
  return 0;
}

std::string klartext_comment(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    const char kept = c >= 0x20 && c < 0x7f && c != '~' && c != ';' ? c : ' ';
    safe += kept >= 'a' && kept <= 'z' ? static_cast<char>(kept - 'a' + 'A') : kept;
  }
  return safe;
}

/// Its lines carry no number: what follows keeps its own where nothing else is inserted.
std::string klartext_header(const KlartextStyle& style, const WriteOptions& options) {
  std::string text;
  for (const std::string& line : options.header) text += "; " + klartext_comment(line) + style.line_end;
  return text;
}

/// `text` with the blocks of its first program numbered one after the other, from its first number on.
std::string renumbered(const std::string& text) {
  std::string result;
  result.reserve(text.size() + text.size() / 64);
  KlartextBlock block;
  std::size_t copied = 0;
  std::optional<unsigned long> next;
  bool ended = false;
  while (!ended && next_klartext_block(text, block)) {
    ended = block.head == "END";
    if (empty(block.number)) continue;
    if (!next) {
      next = 0;
      for (const char c : part(text, block.number).substr(0, 9))
        next = *next * 10 + static_cast<unsigned long>(c - '0');
    }
    result.append(text, copied, block.number.begin - copied).append(std::to_string((*next)++));
    copied = block.number.end;
  }
  return result.append(text, copied);
}

std::string with_changes(const std::string& text, const std::vector<KlartextChange>& changes) {
  std::string result;
  result.reserve(text.size() + text.size() / 8);
  std::size_t copied = 0;
  for (const KlartextChange& change : changes) {
    assert(change.span.begin >= copied);
    result.append(text, copied, change.span.begin - copied).append(change.text);
    copied = change.span.end;
  }
  return result.append(text, copied);
}

/// Moves that are not edited keep their text; an arc among them needs the centre that it had.
void pass_over(const Program& program, std::size_t move, KlartextHeld& held) {
  held.position = held_after_original(program.moves[move], held.position);
  if (program.moves[move].arc && program.moves[move].arc->absolute_centre)
    held.pole_mm = program.moves[move].arc->centre_mm;
}

bool has_lost_pole(const Move& move, const KlartextHeld& held) {
  return move.arc && move.arc->absolute_centre && !move.arc->centre_words[0] && held.pole_mm &&
         (*held.pole_mm - move.arc->centre_mm).head<2>().norm() > 1e-9;
}

/// A program being written, from move to move.
struct KlartextOutput {
  const Program& program;
  const KlartextStyle style;
  const WriteOptions& options;
  KlartextHeld held{};
  std::size_t next = 0;  ///< move
  std::vector<KlartextChange> changes{};
  Rewritten out{};
};

void write_move(KlartextOutput& o, const MoveEdit& edit) {
  rewrite_klartext_block(o.program, o.style, edit, o.options, o.held, o.changes, o.out);
  o.next = edit.move + 1;
}

/// Moves up to `end` that are not edited.
void pass_until(KlartextOutput& o, std::size_t end) {
  while (o.next < end) {
    const Move& move = o.program.moves[o.next];
    if (has_lost_pole(move, o.held))
      write_move(o, {.move = o.next, .end_mm = move.end_mm, .centre_mm = move.arc->centre_mm});
    else
      pass_over(o.program, o.next++, o.held);
  }
}

}  // namespace

Rewritten rewrite_klartext(const Program& program, const std::vector<MoveEdit>& edits,
                           const WriteOptions& options) {
  KlartextOutput o{program, klartext_style(program), options};
  const std::size_t header = klartext_header_position(program);
  std::string head = klartext_header(o.style, options);
  if (!head.empty() && header > 0 && program.text[header - 1] != '\n') head.insert(0, o.style.line_end);
  if (!head.empty()) o.changes.push_back({{header, header}, head});

  for (const MoveEdit& edit : edits) {
    pass_until(o, edit.move);
    const std::size_t inserted = o.out.inserted_blocks;
    write_move(o, edit);
    o.out.blocks_of_edit.push_back(o.out.inserted_blocks - inserted);
  }
  pass_until(o, program.moves.size());
  // The CC of an arc may stand before other moves.
  std::stable_sort(o.changes.begin(), o.changes.end(), [](const KlartextChange& a, const KlartextChange& b) {
    return a.span.begin < b.span.begin;
  });
  o.out.text = with_changes(program.text, o.changes);
  if (o.style.numbered && o.out.inserted_blocks > 0) o.out.text = renumbered(o.out.text);
  return std::move(o.out);
}

}  // namespace counterflex
