#include "same_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "counterflex/geometry/units.hpp"
#include "emit.hpp"

namespace counterflex {
namespace {

struct Line {
  int number;  // of the text
  std::string text;
};

// The line without the number that Klartext gives its blocks anew, and without the surface of a drilling
// cycle, which goes along with its holes; nothing of a CC, which belongs to the arc behind it.
std::string statement_of(const Program& program, std::string_view line) {
  if (program.dialect != "heidenhain") return std::string(line);
  line.remove_prefix(std::min(line.find_first_not_of(" \t0123456789"), line.size()));
  if (line.starts_with("CC")) return {};
  std::string statement(line);
  const std::size_t surface = statement.find("Q203=");
  if (surface != std::string::npos)
    statement.erase(surface, std::min(statement.find(' ', surface), statement.size()) - surface);
  return statement;
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
    std::string statement = statement_of(program, line);
    const bool inserted_centre = statement.empty() && program.dialect == "heidenhain";
    if (!moves && !is_header(statement) && !inserted_centre) lines.push_back({number, std::move(statement)});
    begin = end + 1;
  }
  return lines;
}

[[noreturn]] void fail(const Program& corrected, int line, const std::string& what) {
  throw InputError(Exit::not_compensated, {corrected.file, line, 1}, what);
}

// The surface from which the holes of a Klartext cycle count, where the first of them is met.
struct Surface {
  int line;
  double z_mm, before_mm;  // itself, and the last Z before it that is known
};

std::vector<Surface> surfaces_of(const Program& program) {
  std::vector<Surface> surfaces;
  double before_mm = 0;
  for (const Move& move : program.moves) {
    if (move.words[2] && move.words[2]->number.begin < move.block.begin)
      surfaces.push_back({move.line, move.end_mm.z(), before_mm});
    else if (move.known_end[2])
      before_mm = move.end_mm.z();
  }
  return surfaces;
}

// A surface goes along with the holes, which keep the shift with which they are entered.
void check_surfaces(const Program& original, const Program& corrected) {
  constexpr double rounding_mm = 1e-3 * (1 + 1e-9);  // of both, to three decimals
  const auto wanted = surfaces_of(original), found = surfaces_of(corrected);
  if (found.size() != wanted.size())
    fail(corrected, found.empty() ? 1 : found.back().line,
         "the surfaces of cycles are not those of the original");
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double shift = found[i].z_mm - wanted[i].z_mm, held = found[i].before_mm - wanted[i].before_mm;
    if (std::abs(shift - held) > rounding_mm)
      fail(corrected, found[i].line,
           fmt::format("the surface of this hole's cycle is shifted by {:.4f} mm, the hole by {:.4f} mm",
                       shift, held));
  }
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
  check_surfaces(original, corrected);
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
