#include "program/robot/parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "counterflex/files/input_error.hpp"
#include "program/dialect.hpp"

namespace counterflex {
namespace {

/// How the programs of a dialect are divided, and joined again.
struct Division {
  std::string_view dialect;
  std::vector<ProgramPart> (*divide)(const std::string& file, const std::string& text, std::size_t most);
  std::string (*join)(const std::string& file, const std::vector<ProgramPart>& parts);
};

constexpr std::array divisions{
    Division{tp_name, divide_tp, joined_tp}, Division{kuka_name, divide_krl, joined_krl},
    Division{abb_name, divide_rapid, joined_rapid}, Division{yaskawa_name, divide_jbi, joined_jbi}};

const Division* division_of(std::string_view dialect) {
  const auto found = std::ranges::find(divisions, dialect, &Division::dialect);
  return found != divisions.end() ? &*found : nullptr;
}

int line_at(std::string_view text, std::size_t byte) {
  return 1 +
         static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(byte), '\n'));
}

}  // namespace

std::vector<std::size_t> begins_of_parts(const std::string& file, std::string_view text,
                                         const std::vector<PartStatement>& statements, std::size_t most) {
  std::vector<std::size_t> begins{0};
  std::size_t points = 0, place = 0, rapid = 0;  // where the part may end; the begin of the part: nowhere
  for (std::size_t i = 0; i < statements.size(); ++i) {
    const PartStatement& statement = statements[i];
    if (statement.may_begin) place = i;
    if (statement.may_begin && statement.is_rapid) rapid = i;
    points += statement.points;
    if (points <= most) continue;
    const std::size_t begin = rapid > begins.back() ? rapid : place;
    if (begin <= begins.back())
      throw InputError(ErrorKind::program_text, {file, line_at(text, statement.span.begin), 1},
                       fmt::format("a part of at most {} points cannot end before this statement; give "
                                   "--max-points a larger number",
                                   most));
    begins.push_back(begin);
    points = 0;
    place = rapid = begin;
    i = begin - 1;  // the statements behind it are counted again
  }
  return begins;
}

void refuse_part(const std::string& file, const RobotLine& line, std::string_view why) {
  throw InputError(
      ErrorKind::program_text, {file, line.line, 1},
      fmt::format("the program cannot be divided into parts: {}; divide it where it was posted, or "
                  "give --max-points a larger number",
                  why));
}

bool can_be_divided(std::string_view dialect) {
  return why_not_divided(dialect).empty();
}

std::string_view why_not_divided(std::string_view dialect) {
  if (division_of(dialect) != nullptr) return {};
  if (dialect == ur_name) return "a URScript program cannot call one of another file";
  if (dialect == apt_name) return "APT is the input of a post, which divides its output";
  return "programs of this language are not divided into parts";
}

std::vector<ProgramPart> divide_program(const std::string& file, std::string_view dialect,
                                        const std::string& text, std::size_t most) {
  const Division& division = *division_of(dialect);
  std::vector<ProgramPart> parts = division.divide(file, text, most);
  if (division.join(file, parts) != division.join(file, {{"", text}}))
    throw InputError(ErrorKind::program_text, {file},
                     "the parts of the program are not the same as the program; leave out --max-points");
  return parts;
}

}  // namespace counterflex
