#include "counterflex/program/program_reader.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "program/block_reader.hpp"
#include "program/detect/choose_dialect.hpp"
#include "program/klartext/lex.hpp"
#include "program/robot/apt/lex.hpp"

namespace counterflex {
namespace {

constexpr std::size_t bytes_at_once = 1 << 18;

constexpr double way_of_a_place = 5;  // mm
constexpr std::size_t places_of_a_line = 64, places_of_a_turn = 16;

/// Long moves or many turns fill a window as many short moves do.
std::size_t size_of(const Move& move) {
  if (move.arc) return places_of_a_turn * (static_cast<std::size_t>(move.arc->turns) + 1);
  if (move.motion == Motion::rapid || !all_known(move.known_start) || !all_known(move.known_end)) return 1;
  const double places = std::ceil((move.end_mm - move.start_mm).norm() / way_of_a_place);
  return places < places_of_a_line ? std::max(static_cast<std::size_t>(places), std::size_t{1})
                                   : places_of_a_line;
}

/// Both sides of a corner are judged together.
bool begins_at_corner(const Move& move) {
  return move.corners && move.corners->begin_mm > 0;
}

/// A window of this multiple of the required size may end at a corner, which is then not judged. This limits
/// the memory of a program with a corner at each line.
constexpr std::size_t largest_at_corner = 16;

/// A window of this multiple of the required size may end before a move along Z. This limits the memory of a
/// program without moves across.
constexpr std::size_t largest_along_z = 2;

/// End of the last whole block of `text` that ends behind byte `from`; 0 if there is no such block.
std::size_t end_of_blocks(std::string_view text, std::size_t from, const Dialect& dialect) {
  for (std::size_t end = text.size(); end > from;) {
    const std::size_t newline = text.rfind('\n', end - 1);
    if (newline == std::string_view::npos || newline < from) return 0;
    const bool continues = (dialect.name == klartext_name && continues_behind(text, newline)) ||
                           (dialect.name == apt_name && apt_continues_behind(text, newline));
    if (!continues) return newline + 1;
    end = newline;
  }
  return 0;
}

/// Shifts the spans of `move`.
void shift_spans(Move& move, std::ptrdiff_t bytes) {
  const auto shift = [bytes](Span& span) {
    span.begin += static_cast<std::size_t>(bytes);
    span.end += static_cast<std::size_t>(bytes);
  };
  const auto shift_word = [&](auto& word) {
    if (!word) return;
    AxisWord moved = *word;
    shift(moved.number);
    word = moved;
  };
  shift(move.block);
  for (auto& word : move.words) shift_word(word);
  if (move.orientation)
    for (auto& word : move.orientation->words) shift_word(word);
  if (move.arc) {
    for (auto& word : move.arc->centre_words) shift_word(word);
    shift_word(move.arc->radius_word);
  }
  if (move.called && move.called->modal.empty())
    for (auto& height : move.called->heights) shift_word(height);
  if (move.cycle) {
    shift_word(move.cycle->bottom_word);
    shift_word(move.cycle->retract_word);
  }
  if (move.zone) {
    TargetZone zone = *move.zone;
    shift(zone.words);
    move.zone = zone;
  }
}

struct Overall {
  const Dialect* dialect = nullptr;
  Outline outline{};
};

/// Number of bytes that are needed to detect the dialect and other languages.
const Dialect& dialect_of(FileReader& bytes, const std::string& file, const ReadOptions& options) {
  std::string text;
  const std::size_t needed =
      options.dialect == "auto" ? bytes_of_dialect : 1;  // a robot language is detected in the first bytes
  while (text.size() < needed && bytes.append(text, bytes_at_once) > 0) {
  }
  return choose_dialect(text, file, options);
}

/// Scans as much of the file as is needed, then rewinds it.
Overall look_through(FileReader& bytes, const std::string& file, const ReadOptions& options) {
  bytes.rewind();
  const Dialect& dialect = dialect_of(bytes, file, options);
  bytes.rewind();
  OutlineScan scan(dialect, options.harmless_calls);
  if (!scan.may_find()) return {&dialect, {}};
  std::string text;
  while (bytes.append(text, bytes_at_once) > 0) {
    const std::size_t whole = end_of_blocks(text, 0, dialect);
    scan.add(std::string_view(text).substr(0, whole));
    text.erase(0, whole);
  }
  scan.add(text);
  bytes.rewind();
  return {&dialect, scan.finish()};
}

}  // namespace

std::size_t window_size(const Program& window) {
  std::size_t size = 0;
  for (const Move& move : window.moves) size += size_of(move);
  return size;
}

struct ProgramReader::State {
  State(FileReader& source, const std::string& file, const ReadOptions& options, std::size_t moves,
        Overall overall)
      : bytes(source),
        least_moves(moves),
        blocks(make_reader(file, options, *overall.dialect, std::move(overall.outline))) {}

  FileReader& bytes;
  std::size_t least_moves;
  std::unique_ptr<BlockReader> blocks;
  bool begun = false;           ///< a window was read; an empty program is one window, too
  bool all_read = false;        ///< the end of the file was reached
  std::size_t whole = 0;        ///< number of bytes of the text in whole lines
  std::string behind;           ///< text behind the window
  std::size_t behind_read = 0;  ///< number of bytes of it that were read: the line of `Program::after`

  std::size_t counted = 0;  ///< number of moves of the window that are counted in `size`
  std::size_t size = 0;     ///< size of these moves

  Program& program() { return blocks->program(); }

  std::size_t size_so_far() {
    const auto& moves = program().moves;
    for (; counted < moves.size(); ++counted) size += size_of(moves[counted]);
    return size;
  }

  void restart_count() { counted = size = 0; }

  bool append() {
    std::string& text = program().text;
    const std::size_t begin = text.size();
    all_read = bytes.append(text, bytes_at_once) == 0;
    if (const std::size_t end = end_of_blocks(text, begin, blocks->dialect())) whole = end;
    if (all_read) whole = text.size();
    return !all_read;
  }

  void read_whole() {
    while (append()) {
    }
    Program& p = program();
    p = read_program(std::move(p.text), p.file, blocks->options());
  }

  bool read_block() {
    while (!all_read && blocks->position() >= whole) append();
    return blocks->read_block();
  }

  /// Reads plain lines until the window has the size `least` or the next line is not plain.
  void read_plain(std::size_t least) {
    for (std::size_t now = size_so_far(), before = 0; now < least; now = size_so_far()) {
      before = program().moves.size();
      blocks->read_plain(before + (least - now) / places_of_a_line + 1);
      if (program().moves.size() == before) return;
    }
  }

  /// Reads blocks until the window is larger than `least` and may end.
  void read_until_end(std::size_t least) {
    for (;;) {
      read_plain(least);
      const std::size_t before = program().moves.size();
      if (blocks->has_ended() || !read_block()) break;
      const std::size_t now = program().moves.size();
      const bool one = now == before + 1 && size_so_far() > least;
      const bool is_large = size_so_far() / largest_along_z > least;
      if (one && !blocks->has_ended() && may_part_before_last(least) &&
          blocks->may_end_before(program().moves.back(), is_large))
        return end_before_last();
    }
    while (least_moves == whole_program && append()) {
    }
    if (blocks->has_ended()) blocks->remark_rest(std::string_view(program().text).substr(blocks->position()));
    end_here(whole);
  }

  bool may_part_before_last(std::size_t least) {
    return !begins_at_corner(program().moves.back()) || size_so_far() / largest_at_corner > least;
  }

  /// Moves the last move and all text from its line on to the next window.
  void end_before_last() {
    Program& p = program();
    const std::size_t end = p.moves.back().block.begin;
    p.after = std::move(p.moves.back());
    p.moves.pop_back();
    shift_spans(*p.after, -static_cast<std::ptrdiff_t>(end));
    behind_read = blocks->position() - end;
    end_here(end);
  }

  void end_here(std::size_t end) {
    behind.assign(program().text, end);
    program().text.resize(end);
  }

  /// Reads the text behind the end of the program, in portions.
  bool read_rest() {
    append();
    whole = program().text.size();
    blocks->remark_rest(program().text);
    return whole > 0;
  }

  bool next(std::size_t part) {
    Program& p = program();
    restart_count();
    blocks->begin_window(behind_read, std::exchange(p.after, std::nullopt));
    p.text.swap(behind);
    behind.clear();
    behind_read = 0;
    const std::string& text = p.text;
    whole = all_read ? text.size() : end_of_blocks(text, 0, blocks->dialect());
    if (blocks->has_ended()) return read_rest();
    if (blocks->is_read_whole() && !all_read) {
      begun = true;
      read_whole();
      return true;
    }
    if (begun && all_read && text.empty()) return false;
    begun = true;
    read_until_end(least_moves / part);
    return true;
  }

  bool extend() {
    Program& p = program();
    if (!p.after) return false;
    restart_count();
    const std::size_t end = p.text.size();
    p.text += behind;
    shift_spans(*p.after, static_cast<std::ptrdiff_t>(end));
    p.moves.push_back(std::move(*p.after));
    p.after.reset();
    behind.clear();
    whole = all_read ? p.text.size() : end_of_blocks(p.text, 0, blocks->dialect());
    read_until_end(size_so_far());
    return true;
  }
};

ProgramReader::ProgramReader(FileReader& bytes, const std::string& file, const ReadOptions& options,
                             std::size_t least_moves)
    : state_(new State(bytes, file, options, least_moves, look_through(bytes, file, options))) {}

ProgramReader::~ProgramReader() = default;
ProgramReader::ProgramReader(ProgramReader&&) noexcept = default;

bool ProgramReader::next(std::size_t part) {
  return state_->next(part);
}

bool ProgramReader::extend() {
  return state_->extend();
}

const Program& ProgramReader::window() const {
  return state_->blocks->program();
}

Program& ProgramReader::window() {
  return state_->program();
}

void ProgramReader::take_window(Program& program) {
  state_->blocks->take_window(program);
}

struct TextReader::State {
  std::unique_ptr<BlockReader> blocks;
};

TextReader::TextReader(const ProgramReader& original) {
  const BlockReader& blocks = *original.state_->blocks;
  state_.reset(
      new State{make_reader(blocks.program().file, blocks.options(), blocks.dialect(), blocks.outline())});
}

TextReader::TextReader(const Program& original, const ReadOptions& options) {
  const Dialect& dialect = *find_dialect(original.dialect);
  state_.reset(new State{make_reader(original.file, options, dialect,
                                     outline_of(original.text, dialect, options.harmless_calls))});
}

TextReader::~TextReader() = default;
TextReader::TextReader(TextReader&&) noexcept = default;

const Program& TextReader::read(std::string text) {
  BlockReader& blocks = *state_->blocks;
  blocks.begin_window(0, std::nullopt);
  Program& program = blocks.program();
  if (blocks.is_read_whole()) {
    ReadOptions options = blocks.options();
    options.dialect = program.dialect;
    return program = read_program(std::move(text), program.file, options);
  }
  program.text = std::move(text);
  blocks.read_all();
  return program;
}

void TextReader::take_window(Program& program) {
  state_->blocks->take_window(program);
}

}  // namespace counterflex
