#include "program/robot/fanuc/guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/types.hpp"
#include "program/guard/guard_mark.hpp"
#include "program/guard/guard_text.hpp"
#include "program/robot/fanuc/lex.hpp"

namespace counterflex {
namespace {

constexpr int wrong_label = 32701, right_label = 32702;
constexpr std::string_view tp_line_begin = "   1:  ", header_mark = "COUNTERFLEX 1 ";

class TpLines {
 public:
  void remark(const std::string& text) { lines_.push_back(fmt::format("{}!{} ;", tp_line_begin, text)); }

  void add(const std::string& statement) {
    remark(std::string(header_mark).append(guard_mark("", statement)));
    lines_.push_back(fmt::format("{}{} ;", tp_line_begin, statement));
  }

  void refuse_if(const std::string& condition) {
    add(fmt::format("IF {},JMP LBL[{}]", condition, wrong_label));
  }

  std::vector<std::string> take() { return std::move(lines_); }

 private:
  std::vector<std::string> lines_;
};

/// Negative numbers are in brackets.
std::string tp_number(double value) {
  return value < 0 ? fmt::format("({})", guard_number(value)) : guard_number(value);
}

std::optional<int> frame_number(std::string_view name) {
  constexpr std::string_view frame = "UF ";
  if (!name.starts_with(frame)) return std::nullopt;
  int number = 0;
  std::from_chars(name.data() + frame.size(), name.data() + name.size(), number);
  return number;
}

void check_element(int element, double least, double most, TpLines& lines) {
  lines.refuse_if(
      fmt::format("(PR[100,{0}]<{1} OR PR[100,{0}]>{2})", element, tp_number(least), tp_number(most)));
}

/// Angles of the control are from -180 to 180 deg: near these a range continues at the other end.
void check_angle(int element, double angle, TpLines& lines) {
  constexpr double turn = 360;
  double least = angle - guarded_angle_deg, most = angle + guarded_angle_deg;
  if (least >= -turn / 2 && most <= turn / 2) return check_element(element, least, most, lines);
  if (least < -turn / 2) least += turn;
  if (most > turn / 2) most -= turn;
  lines.refuse_if(
      fmt::format("(PR[100,{0}]<{1} AND PR[100,{0}]>{2})", element, tp_number(least), tp_number(most)));
}

void check_frame(const Guard& guard, int number, TpLines& lines) {
  lines.add(fmt::format("PR[100]=UFRAME[{}]", number));
  for (int axis = 0; axis < 3; ++axis) {
    const double value = guard.active.shown_mm[axis];
    check_element(axis + 1, value - guard.window_mm, value + guard.window_mm, lines);
  }
  const Vector3 rpy_deg = to_rpy(*guard.active.R) / deg;
  for (int i = 0; i < 3; ++i) check_angle(i + 4, rpy_deg[i], lines);
}

}  // namespace

// FANUC, "HandlingTool Setup and Operations Manual" V9.40 (MARUHT8SX): section 7.24, position registers:
// PR[i]=UFRAME[j], PR[i,j] is X, Y, Z, W, P, R; "Branching instructions": IF with a parameter and JMP LBL,
// mixed logic in brackets with OR; "Program control instructions": ABORT ends the program, which cannot be
// continued; "Miscellaneous": MESSAGE of at most 24 characters. $MNUFRAMENUM[1] and $MNUTOOLNUM[1] are the
// numbers that UFRAME_NUM and UTOOL_NUM set for group 1. PR[100] is overwritten.
std::vector<std::string> tp_guard(const Guard& guard) {
  TpLines lines;
  lines.remark("COUNTERFLEX 1 GUARD");
  const int number = frame_number(guard.active.name).value_or(0);
  lines.refuse_if(fmt::format("$MNUFRAMENUM[1]<>{}", number));
  if (guard.tool > 0) lines.refuse_if(fmt::format("$MNUTOOLNUM[1]<>{}", guard.tool));
  if (number > 0) check_frame(guard, number, lines);
  lines.add(fmt::format("JMP LBL[{}]", right_label));
  lines.add(fmt::format("LBL[{}]", wrong_label));
  lines.add("MESSAGE[COUNTERFLEX GUARD]");
  lines.add("ABORT");
  lines.add(fmt::format("LBL[{}]", right_label));
  return lines.take();
}

std::string why_no_tp_guard(const Guard& guard) {
  if (frame_number(guard.active.name)) return "";
  return "the first cut has no UF whose number is known: leave out --guard";
}

bool is_tp_guard_line(std::string_view text, std::size_t begin) {
  std::string_view line = text.substr(begin, std::min(text.find('\n', begin), text.size()) - begin);
  const std::size_t colon = line.find(':'), semicolon = line.rfind(';');
  if (colon == std::string_view::npos || semicolon == std::string_view::npos || semicolon <= colon)
    return false;
  line = line.substr(colon + 1, semicolon - colon - 1);
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  return is_tp_guard_statement(text, begin, line.substr(0, line.find_last_not_of(' ') + 1));
}

bool is_tp_guard_statement(std::string_view text, std::size_t begin, std::string_view statement) {
  if (begin == 0) return false;
  const std::size_t end = begin - 1, before = end == 0 ? 0 : text.rfind('\n', end - 1) + 1;
  std::string_view line = text.substr(before, end - before);
  const std::size_t remark = line.find('!');
  if (remark == std::string_view::npos) return false;
  line.remove_prefix(remark + 1);
  if (!line.starts_with(header_mark)) return false;
  line.remove_prefix(header_mark.size());
  return line.starts_with(guard_mark("", statement));
}

}  // namespace counterflex
