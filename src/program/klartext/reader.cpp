#include "program/klartext/reader.hpp"

#include <utility>

#include "program/detect/choose_dialect.hpp"
#include "program/expand/expand.hpp"
#include "program/gcode/moves/contour.hpp"

namespace counterflex {

KlartextReader::KlartextReader(const std::string& file, const ReadOptions& options, const Dialect& dialect,
                               Outline outline)
    : BlockReader(file, options, dialect, std::move(outline)),
      reading_{program(), this->options(), axes_of_tool_change(dialect, options), this->outline().klartext} {
  reading_.state.unit = options.unit;
}

bool KlartextReader::read_block() {
  if (reading_.ended || !next_klartext_block(program().text, block_)) return false;
  block_.file_line = line_of_file(program().expansion, block_.line);
  reading_.place = next_place(reading_.place, block_);
  read_statement(block_, reading_);
  return true;
}

bool KlartextReader::may_end_before(const Move& last, bool anywhere) const {
  const KlartextState& state = reading_.state;
  const bool across = !is_along_z(last) || (anywhere && ends_along_z(program()));
  const bool followed = !last.fixed[0] && !last.fixed[1] && !last.fixed[2] && !last.block_delete;
  const bool alone = followed && !last.takes_no_z && last.group == 0 && !last.arc && !last.polar &&
                     last.handling == Handling::own;
  const bool clear = !state.contour && state.displacements.empty() && !may_skip_or_repeat(reading_);
  // A move that uses words of a block before it needs that block in its window. Each hole of a series may use
  // the surface of the cycle's definition.
  const bool in_series = state.surface && (state.surface->just_set || state.calls_each ||
                                           contains(this->outline().klartext.series, block_.line));
  const bool words_pending = in_series || (state.pole && has_own_words(*state.pole, reading_));
  return across && alone && clear && !words_pending && all_known(last.known_start);
}

void KlartextReader::resume_behind(std::size_t read) {
  reading_.operation.begin_window(program());
  reading_.state.run_begin = 0;
  block_.line_end = {read, read};
}

bool is_corrected_klartext(std::string_view text) {
  KlartextBlock block;
  while (next_klartext_block(text, block)) {
    for (const Span& comment : block.comments)
      if (is_header_comment(part(text, comment))) return true;
    if (!block.parts.empty() && block.head != "BEGIN") return false;
  }
  return false;
}

}  // namespace counterflex
