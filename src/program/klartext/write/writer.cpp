#include "program/klartext/write/writer.hpp"

#include <algorithm>
#include <cassert>

#include "program/dialect.hpp"
#include "program/guard/guard_text.hpp"
#include "program/klartext/write/block.hpp"
#include "program/klartext/write/numbers.hpp"
#include "program/text/lex.hpp"
#include "program/write/text_position.hpp"

namespace counterflex {
namespace {

/// Position behind BEGIN PGM, else the beginning.
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

/// Header lines have no number: later blocks keep their own if nothing else is inserted.
std::string klartext_header(const KlartextStyle& style, const WriteOptions& options) {
  std::string text;
  for (const std::string& line : options.header) text += "; " + klartext_comment(line) + style.line_end;
  return text;
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

/// A move that is not edited keeps its text. An arc needs its original centre.
void keep_move(const Move& move, KlartextTextState& state) {
  state.position = text_position_after_original(move, state.position);
  if (move.arc && move.arc->absolute_centre) state.pole.centre_mm = move.arc->centre_mm;
  if (move.makes_hole && move.words[2]) state.surface.reset();
  reach_surface(move, state);
}

/// Whether an earlier hole has left another surface in the text than in the original.
bool surface_differs(const Move& move, const KlartextTextState& state) {
  return move.repeats_surface && state.surface && *state.surface * mm_per(move.unit) != move.end_mm.z();
}

bool pole_differs(const Move& move, const WrittenPole& pole) {
  if (move.polar && !move.arc) return pole.differs;
  if (!move.arc || !move.arc->absolute_centre || move.arc->centre_words[move.arc->normal == 0 ? 1 : 0])
    return false;
  if (!pole.centre_mm) return false;
  Vector3 off = *pole.centre_mm - move.arc->centre_mm;
  off[move.arc->normal] = 0;
  return off.norm() > 1e-9;
}

/// The pole after an unchanged CC. One of its words may be relative to the position in the text.
WrittenPole pole_of(const Program& program, const KlartextBlock& block, LengthUnit unit,
                    const TextPosition& position) {
  std::vector<KlartextWord> words;
  if (!lex_klartext_words(program.text, program.file, block, words) || words.size() != 2) return {};
  if (words[0].incremental && words[1].incremental) return {};
  Vector3 pole = Vector3::Zero();
  for (const KlartextWord& word : words) {
    const std::size_t axis =
        word.key.size() == 1 ? std::string_view("XYZ").find(word.key[0]) : std::string_view::npos;
    if (axis == std::string_view::npos || !word.literal || (word.incremental && !position[axis])) return {};
    pole[static_cast<Eigen::Index>(axis)] =
        word.value * mm_per(unit) + (word.incremental ? *position[axis] : 0);
  }
  return {pole};
}

/// A window being written, move by move.
struct KlartextOutput {
  const Program& program;
  const KlartextStyle& style;
  const WriteOptions& options;
  KlartextTextState& state;
  std::size_t next = 0;                  ///< move
  std::optional<std::size_t> reached{};  ///< last move up to which all blocks were handled
  KlartextBlock scanned{};               ///< its last block that was handled
  std::vector<KlartextChange> changes{};
  Rewritten out{};
};

/// The last CC before byte `end`.
void scan_until(KlartextOutput& o, std::size_t end, LengthUnit unit) {
  while (o.scanned.line_end.end < end && next_klartext_block(o.program.text, o.scanned))
    if (o.scanned.head == "CC") o.state.pole = pole_of(o.program, o.scanned, unit, o.state.position);
}

/// Handles the blocks between the move and the one before it: CC, and shifts of the coordinates.
void come_to(KlartextOutput& o, std::size_t index) {
  const Move& move = o.program.moves[index];
  if (o.reached && *o.reached == index) return;
  o.reached = index;
  if (const Move* last = move_before(o.program, index)) {
    o.state.position = text_position_between(*last, move, o.state.position);
    if (last->frame != move.frame) o.state.pole.centre_mm.reset();
  }
  scan_until(o, move.block.begin, move.unit);
}

void write_move(KlartextOutput& o, const MoveEdit& edit) {
  come_to(o, edit.move);
  rewrite_klartext_block(o.program, o.style, edit, o.options, o.state, o.changes, o.out);
  o.next = edit.move + 1;
}

/// Moves up to `end` that are not edited.
void keep_moves_until(KlartextOutput& o, std::size_t end) {
  while (o.next < end) {
    const Move& move = o.program.moves[o.next];
    come_to(o, o.next);
    if (pole_differs(move, o.state.pole) || surface_differs(move, o.state))
      write_move(o, {.move = o.next,
                     .end_mm = move.end_mm,
                     .centre_mm = move.arc ? std::optional(move.arc->centre_mm) : std::nullopt});
    else
      keep_move(move, o.state), ++o.next;
  }
}

void add_header(KlartextOutput& o) {
  const std::size_t position = klartext_header_position(o.program);
  std::string header = klartext_header(o.style, o.options);
  if (header.empty()) return;
  if (position > 0 && o.program.text[position - 1] != '\n') header.insert(0, o.style.line_end);
  o.changes.push_back({{position, position}, header});
}

}  // namespace

Rewritten KlartextWriter::write(const Program& window, const std::vector<MoveEdit>& edits) {
  KlartextOutput o{window, style_, options_, text_};
  if (!begun_) add_header(o);
  begun_ = true;
  const Move* cut = options_.guard && !guarded_ ? first_cut(window) : nullptr;
  if (cut != nullptr) {
    const std::size_t at = cut->block.begin;
    o.changes.push_back(
        {{at, at},
         guard_text(window.dialect, *options_.guard, style_.line_end, style_.numbered ? "0 " : "")});
    guarded_ = true;
  }
  for (const MoveEdit& edit : edits) {
    keep_moves_until(o, edit.move);
    const std::size_t inserted = o.out.inserted_blocks;
    write_move(o, edit);
    o.out.blocks_of_edit.push_back(o.out.inserted_blocks - inserted);
  }
  keep_moves_until(o, window.moves.size());
  if (!window.moves.empty()) scan_until(o, window.text.size(), window.moves.back().unit);
  // The CC of an arc may be before other moves.
  std::stable_sort(o.changes.begin(), o.changes.end(), [](const KlartextChange& a, const KlartextChange& b) {
    return a.span.begin < b.span.begin;
  });
  o.out.text = with_changes(window.text, o.changes);
  WrittenNumbers& numbers = text_.numbers;
  numbers.renumbers = style_.numbered && (numbers.renumbers || o.out.inserted_blocks > 0 || cut != nullptr);
  if (style_.numbered) o.out.text = renumbered_klartext(o.out.text, numbers);
  return std::move(o.out);
}

}  // namespace counterflex
