#include "counterflex/report/motion_plan.hpp"

#include <algorithm>
#include <optional>
#include <tuple>

#include "counterflex/toolpath/reach.hpp"
#include "counterflex/toolpath/toolpath.hpp"
#include "report/tally/may_cut.hpp"

namespace counterflex {
namespace {

constexpr std::size_t look_ahead = 64;  // blocks

enum class MoveHandling { corrected, held, grouped, left };

void add_length(const Move& move, const Program& program, CutLength& cut) {
  if (move.cycle) {
    cut.unknown += static_cast<std::size_t>(count_of_holes(move)) - fractions_of_holes(move).size();
    return;
  }
  if (move.motion != Motion::feed && !may_cut(move, program)) return;
  if (all_known(move.known_start) && all_known(move.known_end))
    cut.known_mm += length(curve_of(move));
  else
    ++cut.unknown;
}

/// Whether the place of the move's own correction is known: its end, or the bottom of its hole. The height
/// behind a hole may be unknown.
bool has_known_place(const Move& move) {
  return all_known(move.known_end) || (move.cycle && move.known_end[0] && move.known_end[1]);
}

void put_costly_first(std::vector<PlanRow>& rows) {
  const auto cost = [](const PlanRow& row) {
    return std::make_tuple(row.cut.known_mm, row.cut.unknown, row.count);
  };
  std::stable_sort(rows.begin(), rows.end(),
                   [&](const PlanRow& a, const PlanRow& b) { return cost(a) > cost(b); });
}

}  // namespace

/// Merges the moves with the list of blocks that are not corrected, both in the order of lines.
class MotionPlanner::Window {
 public:
  Window(const Program& program, MotionPlan& plan, Carried& carried)
      : program_(program), left_(program.left_alone), plan_(plan), carried_(carried) {
    std::stable_sort(left_.begin(), left_.end(), [](const LeftAlone& a, const LeftAlone& b) {
      return line_in_text(a) < line_in_text(b);
    });
  }

  void run() {
    find_known_ends();
    for (std::size_t m = 0; m < program_.moves.size(); ++m) {
      list_other_blocks(line_in_text(program_.moves[m]));
      add(m);
    }
    list_other_blocks(0);
    plan_.moves = plan_.corrected + plan_.held + plan_.grouped + plan_.not_corrected;
  }

 private:
  /// For each move the first one, from it on, that has a known place.
  void find_known_ends() {
    next_known_.assign(program_.moves.size(), nullptr);
    const Move* next = nullptr;
    for (std::size_t m = program_.moves.size(); m-- > 0;) {
      const Move& move = program_.moves[m];
      if (move.handling == Handling::own && !any_axis(move.fixed) && has_known_place(move)) next = &move;
      next_known_[m] = next;
    }
  }

  /// Takes blocks of the list up to `line` of the text (0: all) that are not moves; keeps the last reason.
  void list_other_blocks(int line) {
    for (; next_left_ < left_.size() && (line == 0 || line_in_text(left_[next_left_]) <= line);
         ++next_left_) {
      const LeftAlone& block = left_[next_left_];
      if (line_in_text(block) == line || is_move(line_in_text(block))) {
        carried_.reason = block;
        continue;
      }
      plan_.not_corrected += block.machine_position;
      PlanRow& row =
          row_of(block.machine_position ? plan_.left_rows : plan_.other_rows, block.why, block.line, false);
      if (block.feeds) ++plan_.left_cut.unknown, ++row.cut.unknown;
    }
  }

  bool is_move(int line) const {
    const auto at = std::lower_bound(program_.moves.begin(), program_.moves.end(), line,
                                     [](const Move& move, int l) { return line_in_text(move) < l; });
    return at != program_.moves.end() && line_in_text(*at) == line;
  }

  MoveHandling handling_of(std::size_t m) const {
    const Move& move = program_.moves[m];
    if (any_axis(move.fixed)) return MoveHandling::left;
    if (move.handling == Handling::group) return MoveHandling::grouped;
    if (move.handling == Handling::held || holds_in_doubt(move)) return MoveHandling::held;
    if (has_known_place(move)) return MoveHandling::corrected;
    const Move* next = next_known_[m];
    const bool near = next != nullptr && next->block_index - move.block_index <= look_ahead;
    return near && !move.relative ? MoveHandling::corrected : MoveHandling::left;
  }

  /// Whether the start of the move may not be known, so that it keeps the correction of the text.
  bool holds_in_doubt(const Move& move) const {
    if (!carried_.doubtful || !any_axis(carried_.holds) || move.cycle) return false;
    const bool known_end = all_known(move.known_end);
    return !(known_end && all_known(move.known_start)) && (move.motion == Motion::feed || !known_end);
  }

  /// What the text holds behind move `m`.
  void carry(std::size_t m, MoveHandling handling) {
    const Move& move = program_.moves[m];
    const bool corrected = handling == MoveHandling::corrected && has_known_place(move);
    const bool in_doubt = holds_in_doubt(move);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bool& holds = carried_.holds[axis];
      const bool is_left = handling == MoveHandling::left && move.words[axis] && !is_relative(move, axis);
      holds = handling == MoveHandling::grouped || (corrected && move.known_end[axis]) ||
              (in_doubt && move.known_end[axis]) || (holds && !is_left && !move.fixed[axis]);
    }
    carried_.doubtful = leaves_doubt(move, carried_.doubtful);
  }

  void add(std::size_t m) {
    const Move& move = program_.moves[m];
    const std::array<bool, 3> lost = lost_axes(program_, m);
    for (std::size_t axis = 0; axis < 3; ++axis)
      carried_.holds[axis] = move.starts_uncorrected || (carried_.holds[axis] && !lost[axis]);
    const MoveHandling handling = handling_of(m);
    if (moves_tool(move)) count(move, handling);
    carry(m, handling);
  }

  void count(const Move& move, MoveHandling handling) {
    switch (handling) {
      case MoveHandling::corrected:
        ++plan_.corrected;
        add_length(move, program_, plan_.corrected_cut);
        break;
      case MoveHandling::held:
        ++plan_.held;
        add_length(move, program_, plan_.held_cut);
        add_length(move, program_, row_of(plan_.held_rows, why_held(move), move.line, false).cut);
        break;
      case MoveHandling::grouped:
        ++plan_.grouped;
        add_length(move, program_, plan_.grouped_cut);
        add_to_group(move);
        break;
      case MoveHandling::left:
        ++plan_.not_corrected;
        add_length(move, program_, plan_.left_cut);
        add_length(move, program_,
                   row_of(plan_.left_rows, why_left(move), move.line, any_axis(move.fixed)).cut);
        break;
    }
    count_kind(move);
  }

  std::string why_held(const Move& move) const {
    if (move.cycle && move.cycle->repeats == 0) return "a cycle with a count of 0 drills no hole";
    if (move.cycle && move.relative) return "a cycle in G91 holds the shift of the block before it";
    if (holds_in_doubt(move))
      return "a block before it may be skipped ('/') or is not followed, so its start is not known";
    return reason_at(move).value_or("holds the shift of the block before it");
  }

  std::string why_left(const Move& move) const {
    if (any_axis(move.fixed))
      return reason_at(move).value_or("moves to a place that an edit of the text cannot shift");
    std::string axes;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!move.known_end[axis]) axes += "XYZ"[axis];
    return "the position in " + axes + " is unknown here and in the next 64 blocks";
  }

  /// A reason is listed once for consecutive moves.
  std::optional<std::string> reason_at(const Move& move) const {
    const std::optional<LeftAlone>& reason = carried_.reason;
    if (!reason || line_in_text(*reason) > line_in_text(move)) return std::nullopt;
    return reason->why;
  }

  /// The row of the reason; counts the block in it.
  PlanRow& row_of(std::vector<PlanRow>& rows, const std::string& why, int line, bool must_be_zero) const {
    const auto same = [&](const PlanRow& row) { return row.why == why && row.must_be_zero == must_be_zero; };
    auto row = std::find_if(rows.begin(), rows.end(), same);
    if (row == rows.end()) row = rows.insert(rows.end(), {why, 0, {}, {}, must_be_zero});
    ++row->count;
    if (row->lines.size() < lines_of_row) row->lines.push_back(line);
    return *row;
  }

  void add_to_group(const Move& move) {
    if (plan_.groups.empty() || plan_.groups.back().number != move.group)
      plan_.groups.push_back({move.group, move.line, move.line, 0});
    plan_.groups.back().last_line = move.line;
    ++plan_.groups.back().moves;
  }

  void count_kind(const Move& move) {
    if (move.arc) ++plan_.arcs[static_cast<std::size_t>(2 - move.arc->normal)];
    plan_.cycles += static_cast<std::size_t>(count_of_holes(move));
    plan_.relative += move.relative;
    plan_.inverse_time += move.motion == Motion::feed && move.feed_mode == FeedMode::inverse_time;
    ++plan_.tools[move.tool];
  }

  const Program& program_;
  std::vector<LeftAlone> left_;
  std::size_t next_left_ = 0;
  std::vector<const Move*> next_known_;
  MotionPlan& plan_;
  Carried& carried_;
};

void MotionPlanner::add(const Program& window) {
  Window(window, plan_, carried_).run();
}

MotionPlan MotionPlanner::plan() const {
  MotionPlan plan = plan_;
  put_costly_first(plan.held_rows);
  put_costly_first(plan.left_rows);
  return plan;
}

MotionPlan motion_plan(const Program& program) {
  MotionPlanner planner;
  planner.add(program);
  return planner.plan();
}

}  // namespace counterflex
