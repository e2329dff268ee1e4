#include "program/gcode/line_reader.hpp"

#include <utility>

#include "program/detect/choose_dialect.hpp"
#include "program/evaluate/evaluate.hpp"
#include "program/expand/expand.hpp"
#include "program/gcode/moves/contour.hpp"
#include "program/gcode/words/plain_lines.hpp"

namespace counterflex {

LineReader::LineReader(const std::string& file, const ReadOptions& options, const Dialect& dialect,
                       Outline outline)
    : BlockReader(file, options, dialect, std::move(outline)),
      reading_{this->dialect(), this->options(), axes_of_tool_change(dialect, options), program(),
               this->outline()} {
  reading_.state.unit = options.unit;
  reading_.state.absolute_centres = options.absolute_centres;
  reading_.body.jumps = this->outline().jumps;
}

bool LineReader::read_block() {
  if (takes_plain_ && read_plain_lines(reading_, block_, program().moves.size() + 1) > 0) return true;
  const bool found = read_any_line();
  takes_plain_ = !ended_ && takes_plain_lines(reading_);
  return found;
}

void LineReader::read_plain(std::size_t most_moves) {
  if (takes_plain_) read_plain_lines(reading_, block_, most_moves);
}

bool LineReader::read_any_line() {
  if (ended_ || !next_line(program().text, block_)) return false;
  place_in_file(program().expansion, block_);
  if (is_unused(program().expansion, block_.span.begin)) {
    reading_.after_subprogram = true;
    reading_.program_numbers += is_numbered(part(program().text, block_.span));
    return true;
  }
  lex(program().text, program().file, dialect(), block_);
  const bool begun = opened_ || program().block_count > 0;
  if (block_.percent && block_.part_name && begun)
    refuse(program().file, block_, block_.span.begin, "a '%' must be alone in its line");
  if (block_.percent && begun) {
    ended_ = true;
    return true;
  }
  opened_ = opened_ || block_.percent;
  evaluate_words(block_, reading_);
  interpret(block_, reading_);
  take_assignments(block_, reading_);
  ended_ = reading_.ended;
  return true;
}

bool LineReader::may_end_before(const Move& last, bool anywhere) const {
  const ModalState& state = reading_.state;
  const bool across = last.words[0] || last.words[1] || last.arc || (anywhere && ends_along_z(program()));
  const bool alone =
      last.group == 0 && !last.cycle && !last.called && last.handling == Handling::own && !last.block_delete;
  const bool clear = state.contour == Contour::none && state.unknown_modes == 0 && state.displaced == 0 &&
                     !reading_.in_body() && !state.entering_data;
  return last.line == block_.line && across && alone && clear && all_known(last.known_start);
}

void LineReader::resume_behind(std::size_t read) {
  reading_.operation.begin_window(program());
  reading_.run_begin = 0;
  block_.line_end = {read, read};
}

}  // namespace counterflex
