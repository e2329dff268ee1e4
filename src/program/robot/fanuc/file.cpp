// What the statements of a program need from lines far from them.
#include <fmt/format.h>

#include <algorithm>

#include "program/robot/fanuc/positions.hpp"
#include "program/robot/fanuc/read.hpp"
#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// Reads the list of positions from byte `at` on, up to a line that begins with '/'.
class PositionList {
 public:
  PositionList(const std::string& file, std::string_view text, RobotLine line)
      : file_(file), text_(text), line_(line), at_(line.line_end.end) {
    advance_line(at_);
  }

  void read(TpPositions& positions) {
    for (skip_space(); at_ < text_.size() && text_[at_] != '/'; skip_space()) {
      const std::size_t begin = at_;
      const auto operand = tp_operand(text_, {at_, std::min(text_.find('{', at_), text_.size())});
      if (!operand || operand->array != "P" || !operand->number)
        refuse(file_, line_, begin,
               "this is not a position of /POS; write P[1]{ GP1: UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0', "
               "X = 1.0 mm, Y = 2.0 mm, Z = 3.0 mm, W = 0.0 deg, P = 0.0 deg, R = 0.0 deg };");
      const long number = *operand->number;
      const std::size_t end = std::min(text_.find('}', operand->span.end), text_.size());
      if (end == text_.size())
        refuse(file_, line_, begin, fmt::format("the position P[{}] has no '}}' at its end", number));
      std::size_t behind = end + 1;
      if (const std::size_t next = behind_blanks(text_, behind, text_.size());
          next < text_.size() && text_[next] == ';')
        behind = next + 1;
      const auto added = positions.try_emplace(number, TpPosition{{begin, behind}, line_.line});
      if (!added.second)
        refuse(file_, line_, begin,
               fmt::format("the position P[{}] is defined in line {} already; remove one of the two", number,
                           added.first->second.line));
      advance_line(at_ = behind);
    }
  }

 private:
  void skip_space() {
    while (at_ < text_.size() && is_tp_space(text_[at_])) ++at_;
    advance_line(at_);
  }

  /// Moves the line to the one with byte `at`.
  void advance_line(std::size_t at) {
    while (line_.line_end.end <= at && next_physical_line(text_, line_)) {
    }
  }

  const std::string& file_;
  std::string_view text_;
  RobotLine line_;
  std::size_t at_;
};

void count_uses(std::string_view text, const RobotLine& line, TpFile& found) {
  if (part(text, line.code).starts_with("//")) return;  // is not executed
  for (const TpOperand& operand : tp_positions_in(text, line.code)) {
    if (!operand.number) found.computed_index = true;
    if (!operand.number) continue;
    if (const auto position = found.positions.find(*operand.number); position != found.positions.end())
      ++position->second.uses;
  }
}

/// Whether a statement sets UFRAME[n], also under a condition, and n if it is a number.
bool sets_frame(std::string_view statement, std::optional<long>& number) {
  constexpr std::string_view name = "UFRAME[";
  const std::size_t at = statement.rfind(name);
  if (at == std::string_view::npos || statement.find("]=", at) == std::string_view::npos) return false;
  const auto index = tp_integer(statement, at + name.size());
  if (index && statement.substr(index->end).starts_with("]=")) number = index->value;
  return true;
}

/// What a label needs from the statements around it.
void add_flow(std::string_view text, const RobotLine& line, TpFile& found) {
  if (part(text, line.code).starts_with("//")) return;  // is not executed
  const std::string statement = tp_word(part(text, line.code));
  if (std::optional<long> number; sets_frame(statement, number)) found.frames[number] = line.line;
  if (tp_calls(text, line.code)) found.last_call = line.line;
  const std::size_t label = statement.find("LBL[");
  if (found.first_jump == 0 && label != std::string::npos && label > 0) found.first_jump = line.line;
}

/// The numbers of the lines. A line without a number is not counted. Numbers may be left out.
struct Numbering {
  long count = 0, last = 0;
  bool in_order = true;

  void add(std::string_view text, const RobotLine& line) {
    const auto number = tp_line_number(text, line.span);
    if (!number || empty(number->digits)) return;
    const auto value = tp_integer(text, number->digits.begin);
    in_order = in_order && value && value->value > last;
    if (in_order) last = value->value;
    ++count;
  }

  /// Whether LINE_COUNT counts these lines.
  bool is_count(std::string_view digits) const {
    return in_order && (digits == std::to_string(count) || digits == std::to_string(last));
  }
};

}  // namespace

std::optional<Span> line_count_in(std::string_view text, Span line) {
  const std::string_view name = "LINE_COUNT";
  const std::size_t at = behind_blanks(text, line.begin, line.end);
  if (!part(text, {at, line.end}).starts_with(name)) return std::nullopt;
  const std::size_t equals = behind_blanks(text, at + name.size(), line.end);
  if (equals >= line.end || text[equals] != '=') return std::nullopt;
  const auto count = tp_integer(text, equals + 1);
  return count ? std::optional(Span{behind_blanks(text, equals + 1, line.end), count->end}) : std::nullopt;
}

TpFile tp_file(const std::string& file, std::string_view text) {
  TpFile found;
  RobotLine line;
  for (RobotLine at; next_physical_line(text, at);)
    if (tp_section(part(text, at.span)) == TpSection::positions) {
      PositionList(file, text, at).read(found.positions);
      break;
    }
  Numbering numbering;
  for (TpSection section = TpSection::attributes; next_tp_line(text, section, line);) {
    if (const auto next = tp_section(part(text, line.span))) {
      section = *next;
      if (section == TpSection::positions || section == TpSection::end) break;
    } else if (section == TpSection::attributes) {
      if (const auto count = line_count_in(text, line.span)) found.line_count = count;
    } else {
      numbering.add(text, line);
      count_uses(text, line, found);
      add_flow(text, line, found);
    }
  }
  found.numbered = numbering.in_order && numbering.count > 0;
  if (found.line_count && (!found.numbered || !numbering.is_count(part(text, *found.line_count))))
    found.line_count.reset();
  return found;
}

}  // namespace counterflex
