#include "program/robot/rapid/guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/geometry/types.hpp"
#include "program/guard/guard_mark.hpp"
#include "program/guard/guard_text.hpp"

namespace counterflex {
namespace {

class RapidLines {
 public:
  explicit RapidLines(const Guard& guard) { lines_.push_back("! " + guard_title(guard)); }

  void refuse_if(const std::string& condition, const std::string& message) {
    lines_.push_back(marked_line(fmt::format("IF {} THEN ! ", condition), ""));
    lines_.push_back(marked_line(fmt::format("TPWrite \"GUARD: {}\"; ! ", message), ""));
    lines_.push_back(marked_line("EXIT; ! ", ""));
    lines_.push_back(marked_line("ENDIF ! ", ""));
  }

  std::vector<std::string> take() { return std::move(lines_); }

 private:
  std::vector<std::string> lines_;
};

std::string position_text(const Vector3& p) {
  return fmt::format("[{},{},{}]", guard_number(p.x()), guard_number(p.y()), guard_number(p.z()));
}

}  // namespace

// ABB, "Technical reference manual, RAPID Instructions, Functions and Data types" (3HAC050917): data type
// wobjdata (uframe and oframe are poses, oframe in uframe), pose and pos (+ and - of positions), function
// PoseVect (a position in a pose), function Distance (of two positions, mm), instruction TPWrite (at most 40
// characters a line), instruction EXIT (ends the program, which can be started from its begin alone). The
// numbers of the object frame are compared in the world frame, so any division between uframe and oframe is
// right.
std::vector<std::string> rapid_guard(const Guard& guard) {
  RapidLines lines(guard);
  const std::string& object = guard.active.name;
  const std::string origin = fmt::format("PoseVect({0}.uframe,{0}.oframe.trans)", object);
  lines.refuse_if(fmt::format("Distance({},{})>{}", origin, position_text(guard.active.shown_mm),
                              guard_number(guard.window_mm)),
                  object.substr(0, 20) + " POSITION");
  constexpr double arm_mm = 1000;  // of the points that show the axes
  const double turned_mm = arm_mm * std::sin(guarded_angle_deg * deg);
  for (int axis = 0; axis < 2; ++axis) {
    const Vector3 unit = arm_mm * Vector3::Unit(axis);
    lines.refuse_if(
        fmt::format("Distance(PoseVect({0}.uframe,PoseVect({0}.oframe,{1}))-{2},{3})>{4:.3f}", object,
                    position_text(unit), origin, position_text(*guard.active.R * unit), turned_mm),
        object.substr(0, 20) + " ORIENTATION");
  }
  return lines.take();
}

std::string why_no_rapid_guard(const Guard& guard) {
  if (guard.active.name.empty() || guard.active.name == "wobj0")
    return "the first cut uses no work object: its targets are in the world frame of the robot, and there is "
           "nothing to guard; leave out --guard";
  const bool plain = std::all_of(guard.active.name.begin(), guard.active.name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
  return plain ? "" : fmt::format("the work object {} is not a name: leave out --guard", guard.active.name);
}

}  // namespace counterflex
