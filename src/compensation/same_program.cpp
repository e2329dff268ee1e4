#include "same_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "counterflex/geometry/units.hpp"
#include "emit.hpp"

namespace counterflex {
namespace {

struct Line {
  int number;  // of the text
  std::string_view text;
};

// The line without the number that Klartext gives its blocks anew; nothing of a CC, which belongs to the arc
// behind it.
std::string_view statement_of(const Program& program, std::string_view line) {
  if (program.dialect != "heidenhain") return line;
  line.remove_prefix(std::min(line.find_first_not_of(" \t0123456789"), line.size()));
  return line.starts_with("CC") ? std::string_view() : line;
}

// A comment of the header and nothing else.
bool is_header(std::string_view line) {
  if (line.starts_with("; COUNTERFLEX 1") || line.starts_with(";COUNTERFLEX 1")) return true;
  return line.starts_with("(COUNTERFLEX 1") && line.find(')') == line.size() - 1;
}

// The lines of a program that hold no move, without line ends.
std::vector<Line> other_lines(const Program& program) {
  std::vector<Line> lines;
  const std::string_view text = program.text;
  std::size_t move = 0;
  int number = 1;
  for (std::size_t begin = 0; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = text.substr(begin, end - begin);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    while (move < program.moves.size() && line_in_text(program.moves[move]) < number) ++move;
    const bool moves = move < program.moves.size() && line_in_text(program.moves[move]) == number;
    line = statement_of(program, line);
    const bool inserted_centre = line.empty() && program.dialect == "heidenhain";
    if (!moves && !is_header(line) && !inserted_centre) lines.push_back({number, line});
    begin = end + 1;
  }
  return lines;
}

[[noreturn]] void fail(const Program& corrected, int line, const std::string& what) {
  throw InputError(Exit::not_compensated, {corrected.file, line, 1}, what);
}

}  // namespace

std::vector<std::size_t> other_lines_before(const Program& program) {
  const auto others = other_lines(program);
  std::vector<std::size_t> counts;
  std::size_t count = 0;
  for (const Move& move : program.moves) {
    while (count < others.size() && others[count].number < line_in_text(move)) ++count;
    counts.push_back(count);
  }
  return counts;
}

void check_other_lines(const Program& original, const Program& corrected) {
  const auto wanted = other_lines(original), found = other_lines(corrected);
  const auto line_wanted = [&](std::size_t i) { return line_of_file(original.expansion, wanted[i].number); };
  const auto line_found = [&](std::size_t i) { return line_of_file(corrected.expansion, found[i].number); };
  for (std::size_t i = 0; i < found.size(); ++i)
    if (i >= wanted.size() || found[i].text != wanted[i].text)
      fail(corrected, line_found(i),
           i < wanted.size()
               ? fmt::format("differs from line {} of the original, which is no move and must stay as it is",
                             line_wanted(i))
               : std::string("the original has no such line"));
  if (found.size() < wanted.size())
    fail(corrected, found.empty() ? 1 : line_found(found.size() - 1),
         fmt::format("line {} of the original is missing after this line", line_wanted(found.size())));
}

void check_all_moves(const Job& job, const Program& corrected, const std::vector<Piece>& pieces) {
  std::size_t next = 0;
  std::optional<Vector3> here;
  for (const Move& move : corrected.moves) {
    const bool hole = move.cycle && move.known_end[0] && move.known_end[1];
    if (!all_known(move.known_end) && !hole) continue;
    const Vector3 p =
        hole ? job.path.frames[move.offset].X_MW * (bottom_of(move) * mm) : target_of(job, move);
    const auto at = [&](const Vector3& q) { return (p - q).norm() < 1e-9; };
    if (next < pieces.size() && at(pieces[next].commanded.end))
      ++next;
    else if (!(next < pieces.size() && at(pieces[next].commanded.start)) &&
             !(here && (p - *here).norm() < job.options.tolerance))
      fail(corrected, move.line, "this move leaves the path of the original");
    here = target_of(job, move);
  }
  if (next < pieces.size())
    fail(corrected, corrected.moves.empty() ? 1 : corrected.moves.back().line,
         fmt::format("no move follows the original's line {}", pieces[next].line));
}

}  // namespace counterflex
