#include "compensation/match/corrected_moves.hpp"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>

#include "counterflex/program/kept_words.hpp"
#include "counterflex/program/program.hpp"
#include "counterflex/program/read_program.hpp"

namespace counterflex {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

bool is_klartext(const Program& window) {
  return window.dialect == "heidenhain";
}

// A Sinumerik's MCALL with a drilling cycle. It is written again before holes.
bool calls_modal_cycle(std::string_view line) {
  const auto skip = [&line](std::string_view characters) {
    line.remove_prefix(std::min(line.find_first_not_of(characters), line.size()));
  };
  skip(" \t");
  if (line.starts_with('N') || line.starts_with('n')) line.remove_prefix(1), skip("0123456789"), skip(" \t");
  return modal_drilling_cycle(line).has_value();
}

// The line from byte `begin` on without `spans`, of which `next` is the first that may be in the line. A span
// may have several lines.
std::string without(const std::vector<Span>& spans, const std::string& text, std::string_view line,
                    std::size_t begin, std::size_t& next) {
  std::string rest;
  std::size_t at = begin;
  const std::size_t end = begin + line.size();
  for (; next < spans.size() && spans[next].begin <= end; ++next) {
    const Span span = spans[next];
    if (span.begin > at) rest.append(text, at, span.begin - at);
    at = std::max(at, std::min(span.end, end));
    if (span.end > end) break;
  }
  return rest.append(text, at, end - at);
}

// Whether one of the spans `first` to `last` has a part of the line from byte `begin` on.
bool touches(const std::vector<Span>& spans, std::size_t first, std::size_t last, std::string_view line,
             std::size_t begin) {
  for (std::size_t i = first; i <= last && i < spans.size(); ++i)
    if (spans[i].begin <= begin + line.size() && spans[i].end > begin) return true;
  return false;
}

// The numbers of targets that are in other lines than their moves, in the order of the text. Of Klartext they
// are the surfaces of drilling cycles.
std::vector<Span> declared_numbers(const Program& window) {
  std::vector<Span> numbers;
  if (!is_robot_dialect(window.dialect) && !is_klartext(window)) return numbers;
  for (const Move& move : window.moves) {
    const auto add = [&](const PackedAxisWord& word) {
      if (word && (word->number.begin < move.block.begin || word->number.end > move.block.end))
        numbers.push_back(word->number);
    };
    for (const auto& word : move.words) add(word);
    if (move.orientation)
      for (const auto& word : move.orientation->words) add(word);
    if (move.arc)
      for (const auto& word : move.arc->centre_words) add(word);
  }
  std::sort(numbers.begin(), numbers.end(), [](Span a, Span b) { return a.begin < b.begin; });
  return numbers;
}

struct TextLine {
  std::string_view text;
  std::size_t begin;  // in the window
};

// From byte `begin` to the line feed at `end`. The header goes in behind the mark of UTF-8, before the rest
// of the first line.
TextLine text_line(std::string_view text, std::size_t begin, std::size_t end, bool is_first) {
  if (is_first && text.substr(begin).starts_with(byte_order_mark)) begin += byte_order_mark.size();
  std::string_view line = text.substr(begin, end - begin);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return {line, begin};
}

// The line without the numbers of targets that it gives moves in other lines; empty if it gives none. `next`:
// the first of `declared` that may be in the line.
std::string without_targets(const Program& window, const std::vector<Span>& declared, const TextLine& line,
                            std::size_t& next) {
  const std::size_t first = next;
  const std::string rest = without(declared, window.text, line.text, line.begin, next);
  if (rest.size() == line.text.size()) return {};
  if (is_klartext(window)) return line_kept_words(window, line.text, rest);
  const auto at = [&](std::size_t i) { return declared.begin() + std::min(i, declared.size()); };
  return declared_kept_words(window, {line.begin, line.begin + line.text.size()}, {at(first), at(next)});
}

// The moves of the window in the order of their lines: those of a loop over a data list are in lines far
// behind it.
std::vector<std::size_t> in_text_order(const Program& window) {
  std::vector<std::size_t> order(window.moves.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto is_before = [&](std::size_t a, std::size_t b) {
    return window.moves[a].block.begin < window.moves[b].block.begin;
  };
  if (!std::is_sorted(order.begin(), order.end(), is_before))
    std::stable_sort(order.begin(), order.end(), is_before);
  return order;
}

// A comment of the header and nothing else.
bool is_header(std::string_view line) {
  for (const std::string_view mark : {";", "!", "#", "$$", "'"})  // of robot languages, too
    for (const std::string_view text : {" COUNTERFLEX 1", "COUNTERFLEX 1"})
      if (line.starts_with(mark) && line.substr(mark.size()).starts_with(text)) return true;
  return line.starts_with("(COUNTERFLEX 1") && line.find(')') == line.size() - 1;
}

// A '~' at the end of a line continues the statement in the next.
bool continues(std::string_view line) {
  const std::size_t last = line.find_last_not_of(" \t");
  return last != std::string_view::npos && line[last] == '~';
}

// A line without a move that leaves the parameters of cycles as they are: comments, corners, M functions,
// coordinates.
bool keeps_parameters(std::string_view statement) {
  for (const std::string_view head : {";", "(", "RND", "CHF", "CYCL", "M"})
    if (statement.starts_with(head)) return true;
  return false;
}

}  // namespace

bool are_equal(const OtherLine& a, const OtherLine& b) {
  return a.text == b.text || (!a.without_targets.empty() && a.without_targets == b.without_targets);
}

void OtherLines::end_statement() {
  std::vector<std::string> texts;
  for (const OtherLine& line : statement_)
    texts.push_back(line.without_targets.empty() ? line.text : line.without_targets);
  if (!sets_surface_ || texts != last_surface_) {
    count_ += statement_.size();
    lines.insert(lines.end(), statement_.begin(), statement_.end());
  }
  // To repeat a definition behind what may have changed its other parameters would set these back.
  const bool defined = !last_surface_.empty() && last_surface_[0].starts_with("CYCL");
  if (defined && !sets_surface_ && !texts.empty() && !keeps_parameters(texts[0])) last_surface_.clear();
  if (sets_surface_) last_surface_ = std::move(texts);
  sets_surface_ = false;
  statement_.clear();
}

void OtherLines::end_calls(bool at_hole) {
  for (WaitingLine& waiting : waiting_) {
    if (waiting.calls && at_hole) continue;
    lines.push_back(std::move(waiting.line));
    ++count_;
  }
  waiting_.clear();
}

// Elsewhere the checks of a guard could skip moves.
bool OtherLines::is_of_guard(const Program& window, std::size_t line_begin) {
  if (guard_ == Guard::behind) return false;
  auto line = line_of_guard(window, line_begin);
  if (!line) return false;
  guard_ = Guard::inside;
  guard_lines_.push_back({line_of_file(window.expansion, lines_before_ + 1), std::move(*line)});
  return true;
}

std::vector<PlaceAmongLines> OtherLines::add(const Program& window) {
  std::vector<PlaceAmongLines> places(window.moves.size());
  const std::vector<std::size_t> order = in_text_order(window);
  std::size_t next_move = 0;
  const std::string_view text = window.text;
  const std::vector<Span> declared = declared_numbers(window);
  const PositionWords positions(window);
  std::size_t next_count = 0, next_number = 0;
  const bool klartext = is_klartext(window), siemens = window.dialect == "siemens";
  for (std::size_t begin = 0; begin < text.size(); ++lines_before_) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const auto [line, line_begin] = text_line(text, begin, end, lines_before_ == 0);
    begin = end + 1;
    bool moves = false;
    for (; next_move < order.size() && window.moves[order[next_move]].block.begin <= end; moves = true) {
      const Move& move = window.moves[order[next_move]];
      end_calls(move.called && !move.called->modal.empty());
      if (guard_ == Guard::inside || move.motion == Motion::feed || move.cycle) guard_ = Guard::behind;
      places[order[next_move++]] = {count_, acting_.of(window, move) + positions.of(move)};
    }
    if (moves) {
      end_statement();
      // A statement may continue in further lines.
      while (begin < window.moves[order[next_move - 1]].block.end) {
        begin = std::min(text.find('\n', begin), text.size()) + 1;
        ++lines_before_;
      }
      continue;
    }
    const bool calls = siemens && calls_modal_cycle(line);
    if (is_of_guard(window, line_begin)) continue;
    const Span span{line_begin, line_begin + line.size()};
    acting_.read(window, span);
    const std::size_t first_count = next_count;
    std::string counted = without(window.counts, window.text, line, line_begin, next_count);
    // A target of moves may have lines of its own.
    const bool of_target = counted.find_first_not_of(" \t") == std::string::npos &&
                           touches(window.counts, first_count, next_count, line, line_begin);
    if (of_target) continue;
    std::string statement = line_kept_words(window, line, std::move(counted)) + positions.of(span);
    if (is_header(statement) || (klartext && statement.empty())) continue;
    if (guard_ == Guard::inside) guard_ = Guard::behind;
    if (calls || !waiting_.empty()) {
      waiting_.push_back({{line_of_file(window.expansion, lines_before_ + 1), std::move(statement)}, calls});
      continue;
    }
    const bool ends = !klartext || !continues(statement);
    statement_.push_back({line_of_file(window.expansion, lines_before_ + 1), std::move(statement)});
    OtherLine& added = statement_.back();
    added.without_targets = without_targets(window, declared, {line, line_begin}, next_number);
    sets_surface_ = sets_surface_ || (klartext && !added.without_targets.empty());
    if (ends) end_statement();
  }
  end_statement();
  end_calls(false);
  return places;
}

const CorrectedMove* CorrectedMoves::at(std::size_t index) {
  while (first_ + index >= moves_.size())
    if (!read_on()) return nullptr;
  return &moves_[first_ + index];
}

void CorrectedMoves::drop(std::size_t count) {
  first_ += count;
  while (!windows_.empty() && (first_ == moves_.size() || moves_[first_].program != &windows_.front()))
    windows_.pop_front();
}

bool CorrectedMoves::read_on() {
  if (!read_) return false;
  Program window;
  if (!read_(window)) {
    read_ = nullptr;
    return false;
  }
  moves_.erase(moves_.begin(), moves_.begin() + first_);
  first_ = 0;
  add(windows_.emplace_back(std::move(window)));
  drop(0);
  return true;
}

void CorrectedMoves::add(const Program& window) {
  const std::vector<PlaceAmongLines> places = other_lines_.add(window);
  moves_.reserve(moves_.size() + places.size());
  for (std::size_t m = 0; m < places.size(); ++m)
    moves_.push_back({&window, &window.moves[m], places[m].others,
                      kept_words(window, window.moves[m]) + places[m].acting});
}

}  // namespace counterflex
