#include "counterflex/program/program_reader.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "program/klartext_lex.hpp"
#include "program/line_reader.hpp"

namespace counterflex {
namespace {

constexpr std::size_t bytes_at_once = 1 << 18;

constexpr double way_of_a_place = 5;  // mm
constexpr std::size_t places_of_a_line = 64, places_of_a_turn = 16;

/// About as many as the places at which the move is solved: a window of long moves or of many turns is as large as
/// one of many short moves.
std::size_t size_of(const Move& move) {
  if (move.arc) return places_of_a_turn * (static_cast<std::size_t>(move.arc->turns) + 1);
  if (move.motion == Motion::rapid || !all_known(move.known_start) || !all_known(move.known_end)) return 1;
  const double places = std::ceil((move.end_mm - move.start_mm).norm() / way_of_a_place);
  return places < places_of_a_line ? std::max(static_cast<std::size_t>(places), std::size_t{1}) : places_of_a_line;
}

/// A window so many times as large as it must be may end before a move along Z: the memory of a program that never
/// moves across is limited, too.
constexpr std::size_t largest_along_z = 2;

/// The whole lines at the beginning of `text`.
std::string_view whole_lines(const std::string& text) {
  const std::size_t newline = text.rfind('\n');
  return std::string_view(text).substr(0, newline == std::string::npos ? 0 : newline + 1);
}

/// Moves the spans of `move` by so many bytes.
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
  if (move.arc) {
    for (auto& word : move.arc->centre_words) shift_word(word);
    shift_word(move.arc->radius_word);
  }
  if (move.cycle) {
    shift_word(move.cycle->bottom_word);
    shift_word(move.cycle->retract_word);
  }
}

/// Whether a program cannot be read in windows.
bool is_read_whole(const LineReader& lines) {
  return lines.program().dialect == klartext_name || lines.options().expand_subprograms;
}

struct Overall {
  const Dialect* dialect = nullptr;
  Outline outline{};
};

/// What `auto` looks at.
const Dialect& dialect_of(FileReader& bytes, const std::string& file, const ReadOptions& options) {
  std::string text;
  const std::size_t needed = options.dialect == "auto" ? looked_at : 1;  // a robot's language is seen at once
  while (text.size() < needed && bytes.append(text, bytes_at_once) > 0) {
  }
  return choose_dialect(text, file, options);
}

/// Looks through as much of the file as is needed, which is at its beginning afterwards.
Overall look_through(FileReader& bytes, const std::string& file, const ReadOptions& options) {
  bytes.rewind();
  const Dialect& dialect = dialect_of(bytes, file, options);
  bytes.rewind();
  OutlineScan scan(dialect);
  if (!scan.may_find()) return {&dialect, {}};
  std::string text;
  while (bytes.append(text, bytes_at_once) > 0) {
    const std::size_t whole = whole_lines(text).size();
    scan.add(std::string_view(text).substr(0, whole));
    text.erase(0, whole);
  }
  scan.add(text);
  bytes.rewind();
  return {&dialect, scan.finish()};
}

}  // namespace

struct ProgramReader::State {
  State(FileReader& source, const std::string& file, const ReadOptions& options, std::size_t moves,
        Overall overall)
      : bytes(source), least_moves(moves), lines(file, options, *overall.dialect, overall.outline) {}

  FileReader& bytes;
  std::size_t least_moves;
  LineReader lines;
  bool begun = false;           ///< an empty program is one window, too
  bool all_read = false;        ///< the bytes have come to their end
  std::size_t whole = 0;        ///< bytes of the text that are whole lines
  std::string behind;           ///< text behind the window
  std::size_t behind_read = 0;  ///< bytes of it that have been read: the line of `Program::after`

  std::size_t counted = 0;  ///< moves of the window that are in `size`
  std::size_t size = 0;     ///< of these moves

  Program& program() { return lines.program(); }

  std::size_t window_size() {
    const auto& moves = program().moves;
    for (; counted < moves.size(); ++counted) size += size_of(moves[counted]);
    return size;
  }

  void restart_count() { counted = size = 0; }

  bool append() {
    std::string& text = program().text;
    const std::size_t begin = text.size();
    all_read = bytes.append(text, bytes_at_once) == 0;
    const std::size_t newline = text.rfind('\n');
    if (newline != std::string::npos && newline >= begin) whole = newline + 1;
    if (all_read) whole = text.size();
    return !all_read;
  }

  void read_whole() {
    while (append()) {
    }
    Program& p = program();
    p = read_program(std::move(p.text), p.file, lines.options());
  }

  bool read_line() {
    while (!all_read && lines.position() >= whole) append();
    return lines.read_line();
  }

  /// Reads plain lines until the window has `least` or the next line is not plain.
  void read_plain(std::size_t least) {
    for (std::size_t now = window_size(), before = 0; now < least; now = window_size()) {
      before = program().moves.size();
      lines.read_plain(before + (least - now) / places_of_a_line + 1);
      if (program().moves.size() == before) return;
    }
  }

  /// Reads on until the window is larger than `least` and may end.
  void read_until_end(std::size_t least) {
    for (;;) {
      read_plain(least);
      const std::size_t before = program().moves.size();
      if (lines.has_ended() || !read_line()) break;
      const std::size_t now = program().moves.size();
      const bool one = now == before + 1 && window_size() > least;
      const bool is_large = window_size() / largest_along_z > least;
      if (one && !lines.has_ended() && lines.may_end_before(program().moves.back(), is_large)) return end_before_last();
    }
    while (least_moves == whole_program && append()) {
    }
    if (lines.has_ended()) lines.remark_rest(std::string_view(program().text).substr(lines.position()));
    end_here(whole);
  }

  /// The last move and all text from its line on belong to the next window.
  void end_before_last() {
    Program& p = program();
    const std::size_t end = p.moves.back().block.begin;
    p.after = std::move(p.moves.back());
    p.moves.pop_back();
    shift_spans(*p.after, -static_cast<std::ptrdiff_t>(end));
    behind_read = lines.position() - end;
    end_here(end);
  }

  void end_here(std::size_t end) {
    behind.assign(program().text, end);
    program().text.resize(end);
  }

  /// What is behind the end of the program, a portion at a time.
  bool read_rest() {
    append();
    whole = program().text.size();
    lines.remark_rest(program().text);
    return whole > 0;
  }

  bool next() {
    Program& p = program();
    restart_count();
    lines.begin_window(behind_read, std::exchange(p.after, std::nullopt));
    p.text.swap(behind);
    behind.clear();
    behind_read = 0;
    const std::string& text = p.text;
    whole = all_read ? text.size() : whole_lines(text).size();
    if (lines.has_ended()) return read_rest();
    if (is_read_whole(lines) && !all_read) {
      begun = true;
      read_whole();
      return true;
    }
    if (begun && all_read && text.empty()) return false;
    begun = true;
    read_until_end(least_moves);
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
    whole = all_read ? p.text.size() : whole_lines(p.text).size();
    read_until_end(window_size());
    return true;
  }
};

ProgramReader::ProgramReader(FileReader& bytes, const std::string& file, const ReadOptions& options,
                             std::size_t least_moves)
    : state_(new State(bytes, file, options, least_moves, look_through(bytes, file, options))) {}

ProgramReader::~ProgramReader() = default;
ProgramReader::ProgramReader(ProgramReader&&) noexcept = default;

bool ProgramReader::next() {
  return state_->next();
}

bool ProgramReader::extend() {
  return state_->extend();
}

const Program& ProgramReader::window() const {
  return state_->lines.program();
}

Program& ProgramReader::window() {
  return state_->program();
}

void ProgramReader::take_window(Program& program) {
  state_->lines.take_window(program);
}

struct TextReader::State {
  LineReader lines;
};

TextReader::TextReader(const ProgramReader& original) {
  const LineReader& lines = original.state_->lines;
  state_.reset(new State{{lines.program().file, lines.options(), lines.dialect(), lines.outline()}});
}

TextReader::TextReader(const Program& original, const ReadOptions& options) {
  const Dialect& dialect = *find_dialect(original.dialect);
  state_.reset(new State{{original.file, options, dialect, outline_of(original.text, dialect)}});
}

TextReader::~TextReader() = default;
TextReader::TextReader(TextReader&&) noexcept = default;

const Program& TextReader::read(std::string text) {
  LineReader& lines = state_->lines;
  lines.begin_window(0, std::nullopt);
  Program& program = lines.program();
  if (is_read_whole(lines)) {
    ReadOptions options = lines.options();
    options.dialect = program.dialect;
    return program = read_program(std::move(text), program.file, options);
  }
  program.text = std::move(text);
  lines.read_all();
  return program;
}

void TextReader::take_window(Program& program) {
  state_->lines.take_window(program);
}

}  // namespace counterflex
