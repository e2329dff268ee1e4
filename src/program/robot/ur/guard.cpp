#include "program/robot/ur/guard.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "counterflex/geometry/pose.hpp"
#include "counterflex/geometry/types.hpp"
#include "program/guard/guard_mark.hpp"
#include "program/guard/guard_text.hpp"

namespace counterflex {
namespace {

class UrLines {
 public:
  explicit UrLines(const Guard& guard) { lines_.push_back("# " + guard_title(guard)); }

  void refuse_if(const std::string& condition, const std::string& message) {
    lines_.push_back(marked_line(fmt::format("if {}: # ", condition), ""));
    lines_.push_back(
        marked_line(fmt::format("popup(\"{}\", \"COUNTERFLEX GUARD\", error=True) # ", message), ""));
    lines_.push_back(marked_line("halt # ", ""));
    lines_.push_back(marked_line("end # ", ""));
  }

  void add(const std::string& statement) { lines_.push_back(marked_line(statement + " # ", "")); }

  std::vector<std::string> take() { return std::move(lines_); }

 private:
  std::vector<std::string> lines_;
};

/// Of a length in m or an angle in rad.
std::string fine_number(double value) {
  std::string text = fmt::format("{:.9f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string pose_text(const GuardedOffset& offset) {
  const Vector3 p = offset.shown_mm * mm, r = log_so3(*offset.R);
  return fmt::format("p[{},{},{},{},{},{}]", fine_number(p.x()), fine_number(p.y()), fine_number(p.z()),
                     fine_number(r.x()), fine_number(r.y()), fine_number(r.z()));
}

}  // namespace

// Universal Robots, "The URScript Programming Language" (e-Series, SW 5.11), chapter 2: if, elif, else, end;
// halt ends the program. Chapter "Module urmath": pose_inv, pose_trans, norm (of a list), point_dist (of two
// poses, m). Chapter "Module internals": popup. A pose is in m and a rotation vector in rad, and its numbers
// have indices.
std::vector<std::string> ur_guard(const Guard& guard) {
  UrLines lines(guard);
  const std::string wanted = pose_text(guard.active);
  lines.refuse_if(
      fmt::format("point_dist({},{})>{}", guard.active.name, wanted, fine_number(guard.window_mm * mm)),
      fmt::format("{} must be {} within {} mm", guard.active.name, wanted, guard_number(guard.window_mm)));
  lines.add(fmt::format("counterflex_turn = pose_trans(pose_inv({}), {})", wanted, guard.active.name));
  lines.refuse_if(fmt::format("norm([counterflex_turn[3],counterflex_turn[4],counterflex_turn[5]])>{}",
                              fine_number(guarded_angle_deg * deg)),
                  fmt::format("{} is turned", guard.active.name));
  return lines.take();
}

std::string why_no_ur_guard(const Guard& guard) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  const std::string& name = guard.active.name;
  const bool letter = !name.empty() && !(name[0] >= '0' && name[0] <= '9');
  if (letter && std::all_of(name.begin(), name.end(), is_plain)) return "";
  return "the first cut uses no feature that is a variable: its targets are in the base of the robot, or in "
         "a pose "
         "that is written beside them, and there is nothing to guard; leave out --guard";
}

}  // namespace counterflex
