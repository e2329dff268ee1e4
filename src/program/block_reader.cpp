#include "program/block_reader.hpp"

#include <algorithm>
#include <utility>

#include "counterflex/program/program_reader.hpp"
#include "program/gcode/line_reader.hpp"
#include "program/gcode/remarks.hpp"
#include "program/klartext/reader.hpp"
#include "program/robot/apt/reader.hpp"
#include "program/robot/fanuc/reader.hpp"
#include "program/robot/kuka/reader.hpp"
#include "program/robot/rapid/reader.hpp"
#include "program/robot/ur/reader.hpp"
#include "program/robot/yaskawa/reader.hpp"

namespace counterflex {
namespace {

Program begun(const std::string& file, const ReadOptions& options, const Dialect& dialect) {
  Program program;
  program.file = file;
  program.dialect = dialect.name;
  program.integer_words = options.integer_words;
  return program;
}

}  // namespace

BlockReader::BlockReader(const std::string& file, const ReadOptions& options, const Dialect& dialect,
                         Outline outline)
    : options_(options),
      dialect_(dialect),
      outline_(std::move(outline)),
      program_(begun(file, options, dialect)) {}

void BlockReader::read_plain(std::size_t) {}

void BlockReader::read_all() {
  // Growing step by step would copy every move several times. Reused memory is large enough.
  if (program_.moves.capacity() == 0) {
    const auto newlines = std::count(program_.text.begin(), program_.text.end(), '\n');
    program_.moves.reserve(static_cast<std::size_t>(newlines) + 1);
  }
  do read_plain(whole_program);
  while (read_block());
  remark_rest(std::string_view(program_.text).substr(position()));
}

// A second program behind the end of the first is not corrected.
void BlockReader::remark_rest(std::string_view text) {
  if (end_line() > 0 && text.find_first_not_of("% \t\r\n") != std::string_view::npos)
    add_remark(program_, end_line(), "the text behind the end of the program is not changed");
}

void BlockReader::begin_window(std::size_t read, std::optional<Move> first) {
  if (!program_.moves.empty()) program_.before = std::move(program_.moves.back());
  program_.moves.clear();  // keeps the memory
  if (first) {
    first->operation = 0;  // the operation before the window
    program_.moves.push_back(std::move(*first));
  }
  program_.cutter_diameters.clear();
  program_.left_alone.clear();
  program_.counts.clear();
  program_.expansion.unused.clear();
  program_.text.clear();
  resume_behind(read);
}

void BlockReader::take_window(Program& to) {
  to.file = program_.file;
  to.dialect = program_.dialect;
  to.integer_words = program_.integer_words;
  to.before = program_.before;
  to.after = program_.after;
  to.frames = program_.frames;
  to.operations = program_.operations;
  to.operation_titles = program_.operation_titles;
  to.external_axes_move = program_.external_axes_move;
  to.external_axes = program_.external_axes;
  to.zones = program_.zones;
  to.block_count = program_.block_count;
  to.evaluated = program_.evaluated;
  to.expansion = program_.expansion;
  to.text.swap(program_.text);
  to.moves.swap(program_.moves);
  to.cutter_diameters.swap(program_.cutter_diameters);
  to.left_alone.swap(program_.left_alone);
  to.counts.swap(program_.counts);
  program_.text.clear();
  program_.moves.clear();
  program_.cutter_diameters.clear();
  program_.left_alone.clear();
  program_.counts.clear();
  if (!to.moves.empty()) program_.before = to.moves.back();
}

std::unique_ptr<BlockReader> make_reader(const std::string& file, const ReadOptions& options,
                                         const Dialect& dialect, Outline outline) {
  if (dialect.name == klartext_name)
    return std::make_unique<KlartextReader>(file, options, dialect, std::move(outline));
  if (dialect.name == kuka_name)
    return std::make_unique<KukaReader>(file, options, dialect, std::move(outline));
  if (dialect.name == abb_name)
    return std::make_unique<RapidReader>(file, options, dialect, std::move(outline));
  if (dialect.name == ur_name) return std::make_unique<UrReader>(file, options, dialect, std::move(outline));
  if (dialect.name == apt_name)
    return std::make_unique<AptReader>(file, options, dialect, std::move(outline));
  if (dialect.name == yaskawa_name)
    return std::make_unique<YaskawaReader>(file, options, dialect, std::move(outline));
  if (dialect.name == tp_name)
    return std::make_unique<FanucReader>(file, options, dialect, std::move(outline));
  return std::make_unique<LineReader>(file, options, dialect, std::move(outline));
}

}  // namespace counterflex
