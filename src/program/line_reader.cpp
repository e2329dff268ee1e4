#include "program/line_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/program/program_reader.hpp"
#include "counterflex/program/read_program.hpp"
#include "program/expand.hpp"
#include "program/plain_lines.hpp"
#include "program/remarks.hpp"
#include "program/robot_language.hpp"

namespace counterflex {
namespace {

/// Whole lines, so that no comment loses its end.
std::string_view beginning(std::string_view text) {
  if (text.size() < looked_at) return text;
  text = text.substr(0, looked_at);
  return text.substr(0, text.rfind('\n'));
}

Program begun(const std::string& file, const ReadOptions& options, const Dialect& dialect) {
  Program program;
  program.file = file;
  program.dialect = dialect.name;
  program.integer_words = options.integer_words;
  return program;
}

}  // namespace

std::optional<std::string> unknown_dialect(const std::string& dialect) {
  if (dialect == "auto" || find_dialect(dialect) != nullptr) return std::nullopt;
  return fmt::format("dialect '{}' is not known: {} are", dialect, dialect_names());
}

const Dialect& choose_dialect(std::string_view text, const std::string& file, const ReadOptions& options) {
  if (const std::string_view language = robot_language(text); !language.empty())
    throw InputError(Exit::program_text, {file, 1, 1},
                     fmt::format("this is a program in {}, which is not read yet; G-code, Siemens and Heidenhain "
                                 "programs are: post the job as one of them",
                                 language));
  if (options.dialect == "auto") return detect_dialect(beginning(text));
  if (const auto problem = unknown_dialect(options.dialect)) throw UnknownDialect(Exit::usage, {file}, *problem);
  return *find_dialect(options.dialect);
}

std::array<bool, 3> axes_of_tool_change(const Dialect& dialect, const ReadOptions& options) {
  std::array<bool, 3> axes{};
  axes.fill(!options.tool_change_moves && dialect.tool_change_moves_axes);
  if (!options.tool_change_moves) return axes;
  for (const char letter : *options.tool_change_moves)
    if (letter >= 'X' && letter <= 'Z') axes[static_cast<std::size_t>(letter - 'X')] = true;
  return axes;
}

LineReader::LineReader(const std::string& file, const ReadOptions& options, const Dialect& dialect,
                       Outline outline)
    : options_(options),
      dialect_(dialect),
      program_(begun(file, options_, dialect)),
      reading_{dialect_, options_, axes_of_tool_change(dialect, options_), program_} {
  reading_.state.unit = options_.unit;
  reading_.body.jumps = outline.jumps;
  reading_.outline = std::move(outline);
}

bool LineReader::read_line() {
  if (takes_plain_ && read_plain_lines(reading_, block_, program_.moves.size() + 1) > 0) return true;
  const bool found = read_any_line();
  takes_plain_ = !ended_ && takes_plain_lines(reading_);
  return found;
}

void LineReader::read_plain(std::size_t most_moves) {
  if (takes_plain_) read_plain_lines(reading_, block_, most_moves);
}

bool LineReader::read_any_line() {
  if (ended_ || !next_line(program_.text, block_)) return false;
  place_in_file(program_.expansion, block_);
  if (stands_unused(program_.expansion, block_.span.begin)) {
    reading_.after_subprogram = true;
    reading_.program_numbers += is_numbered(part(program_.text, block_.span));
    return true;
  }
  lex(program_.text, program_.file, dialect_, block_);
  if (block_.percent && (opened_ || program_.block_count > 0)) {
    ended_ = true;
    return true;
  }
  opened_ = opened_ || block_.percent;
  interpret(block_, reading_);
  ended_ = reading_.ended;
  return true;
}

void LineReader::read_all() {
  // Growing step by step would copy every move several times; room that is used again is large enough.
  if (program_.moves.capacity() == 0) {
    const auto newlines = std::count(program_.text.begin(), program_.text.end(), '\n');
    program_.moves.reserve(static_cast<std::size_t>(newlines) + 1);
  }
  do read_plain(whole_program);
  while (read_line());
  remark_rest(std::string_view(program_.text).substr(position()));
}

bool LineReader::may_end_before(const Move& last, bool anywhere) const {
  const ModalState& state = reading_.state;
  const bool across = anywhere || last.words[0] || last.words[1] || last.arc;
  const bool alone = last.group == 0 && !last.cycle && last.handling == Handling::own && !last.block_delete;
  const bool clear = state.contour == Contour::none && state.doubts == 0 && state.displaced == 0 &&
                     !reading_.in_body() && !state.entering_data;
  return last.line == block_.line && across && alone && clear && all_known(last.known_start);
}

// A second program behind the end of the first: nobody corrects it.
void LineReader::remark_rest(std::string_view text) {
  if (reading_.ended && text.find_first_not_of("% \t\r\n") != std::string_view::npos)
    add_remark(program_, block_.line, "what stands behind the end of the program stays as it is");
}

void LineReader::begin_window(std::size_t read, std::optional<Move> first) {
  if (!program_.moves.empty()) program_.before = std::move(program_.moves.back());
  program_.moves.clear();  // the room is used again
  if (first) {
    first->operation = 0;  // what stood last before the window
    program_.moves.push_back(std::move(*first));
  }
  program_.left_alone.clear();
  program_.text.clear();
  reading_.operation.begin_window(program_);
  reading_.run_begin = 0;
  block_.line_end = {read, read};
}

void LineReader::take_window(Program& to) {
  to.file = program_.file;
  to.dialect = program_.dialect;
  to.integer_words = program_.integer_words;
  to.before = program_.before;
  to.after = program_.after;
  to.work_offsets = program_.work_offsets;
  to.operations = program_.operations;
  to.block_count = program_.block_count;
  to.expansion = program_.expansion;
  to.text.swap(program_.text);
  to.moves.swap(program_.moves);
  to.left_alone.swap(program_.left_alone);
  program_.text.clear();
  program_.moves.clear();
  program_.left_alone.clear();
  if (!to.moves.empty()) program_.before = to.moves.back();
}

}  // namespace counterflex
