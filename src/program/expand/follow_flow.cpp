#include "program/expand/follow_flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "program/expand/definitions.hpp"

namespace counterflex {
namespace {

class Follower {
 public:
  Follower(const ControlFlow& flow, const Dialect& dialect, LoopState& loops, Variables& variables)
      : flow_(flow), dialect_(dialect), loops_(loops), variables_(variables) {}

  FlowStep step(const ControlLine& line) {
    switch (line.kind) {
      case FlowKind::jump:
        return {line.condition.empty() || is_true(line) ? target_of(line) : line.behind};
      case FlowKind::begin_if:
        return {branch_of(line)};
      case FlowKind::else_if:
      case FlowKind::otherwise:
        return {partner(line).behind};
      case FlowKind::begin_while:
        return {is_true(line) ? line.behind : behind_while(line)};
      case FlowKind::end_loop:
        return {repeat_or_leave(partner(line))};
      case FlowKind::loop_while:
        return {loop_while(line)};
      case FlowKind::loop_until:
        return {is_true(line) ? line.behind : partner(line).behind};
      case FlowKind::begin_repeat:
        return {begin_repeat(line)};
      case FlowKind::end_repeat:
        return {repeat(line)};
      case FlowKind::begin_for:
        return begin_count(line);
      case FlowKind::end_for:
        return count_on(line);
      case FlowKind::leave_loop:
        return {partner(line).kind == FlowKind::begin_while ? behind_while(partner(line))
                                                            : behind_do(partner(partner(line)))};
      case FlowKind::next_pass:
        return {next_pass(line)};
      case FlowKind::leave_body:
        return leave_body(line);
      case FlowKind::assign_if:
        return {line.behind, {}, is_true(line) ? line.rest : Span{}};
      case FlowKind::not_followed:
        refuse(line, fmt::format("{} is not supported", line.keyword));
      default:
        return {line.behind};
    }
  }

 private:
  [[noreturn]] static void refuse(const ControlLine& line, std::string why) {
    throw UnknownFlow{line.begin.line, std::move(why)};
  }

  const ControlLine& partner(const ControlLine& line) const { return flow_.lines[line.partner]; }

  ConstantValue value_of(std::string_view expression) const {
    return value_of_expression(expression, dialect_, variables_);
  }

  bool is_true(const ControlLine& line) const {
    const ConstantValue truth = value_of(line.condition);
    if (truth.depends_on_rounding)
      refuse(line, fmt::format("the condition {} depends on how the control rounds", line.condition));
    if (!truth.value || (!dialect_.o_words && *truth.value != 0 && *truth.value != 1))
      refuse(line, fmt::format("the condition {} is not known from the text", line.condition));
    return *truth.value != 0;
  }

  LinePlace branch_of(const ControlLine& first) const {
    const ControlLine* line = &first;
    while (line->kind != FlowKind::end_if && line->kind != FlowKind::otherwise && !is_true(*line))
      line = &flow_.lines[line->next_branch];
    return line->behind;
  }

  /// A condition at the beginning is tested again.
  static LinePlace repeat_or_leave(const ControlLine& begin) {
    return begin.kind == FlowKind::begin_while ? begin.begin : begin.behind;
  }

  LinePlace begin_repeat(const ControlLine& line) {
    const auto count = value_of(line.condition).value;
    if (!count || *count != std::round(*count))
      refuse(line, fmt::format("the count {} is not an integer known from the text", line.condition));
    if (loops_.passes_left.contains(&line))
      refuse(line, "the loop calls itself, and LinuxCNC counts the passes of both together");
    if (*count < 1) return behind_loop(line);
    loops_.passes_left[&line] = static_cast<long>(*count);
    return line.behind;
  }

  LinePlace repeat(const ControlLine& end) {
    const auto left = loops_.passes_left.find(&partner(end));
    if (--left->second > 0) return partner(end).behind;
    loops_.passes_left.erase(left);
    return behind_loop(partner(end));
  }

  void refuse_unknown_loops(const ControlLine& line) const {
    if (loops_.is_unknown)
      refuse(line,
             "a call or a loop before its end is not replaced, and a break or continue there can change its "
             "passes in LinuxCNC");
  }

  LinePlace behind_loop(const ControlLine& begin) const {
    refuse_unknown_loops(begin);
    return partner(begin).behind;
  }

  /// LinuxCNC passes the lines from `line` on to the end of its loop.
  void pass_breaks(const ControlLine& line, const ControlLine& begin) {
    loops_.keeps_break =
        loops_.keeps_break || std::any_of(&line, &partner(begin), [&](const ControlLine& passed) {
          return passed.kind == FlowKind::leave_loop && &partner(passed) == &begin;
        });
  }

  LinePlace behind_while(const ControlLine& begin) {
    pass_breaks(begin, begin);
    return behind_loop(begin);
  }

  LinePlace next_pass(const ControlLine& line) {
    pass_breaks(line, partner(line));
    return partner(line).begin;
  }

  LinePlace loop_while(const ControlLine& end) {
    if (!is_true(end)) return behind_do(end);
    refuse_unknown_loops(partner(end));
    if (loops_.keeps_break)
      refuse(end, "the break of a while loop before ends this do loop after its first pass in LinuxCNC");
    return partner(end).behind;
  }

  LinePlace behind_do(const ControlLine& end) {
    loops_.keeps_break = false;
    return behind_loop(partner(end));
  }

  FlowStep leave_body(const ControlLine& line) const {
    if (!line.condition.empty()) refuse(line, "its return has a value");
    FlowStep step{line.behind};
    step.leaves = true;
    return step;
  }

  LinePlace target_of(const ControlLine& line) const {
    if (dialect_.sinumerik_words) return label_of(line);
    const auto number = value_of(line.target).value;
    const bool whole = number && *number >= 0 && *number == std::round(*number);
    if (!whole)
      refuse(line, fmt::format("the target {} of the jump is not a number known from the text", line.target));
    const auto found = flow_.labels.find(fmt::format("{:.0f}", *number));
    if (found == flow_.labels.end())
      refuse(line, fmt::format("N{:.0f}, the target of the jump, is not found", *number));
    if (found->second.size() > 1)
      refuse(line, fmt::format("N{:.0f}, the target of the jump, occurs more than once", *number));
    return found->second.front();
  }

  LinePlace label_of(const ControlLine& line) const {
    const std::size_t blank = std::min(line.target.find(' '), line.target.size());
    const std::string direction = line.target.substr(0, blank),
                      name(trimmed_text(std::string_view(line.target).substr(blank)));
    const auto found = flow_.labels.find(name);
    if (found == flow_.labels.end()) refuse(line, fmt::format("the label {} of the jump is not found", name));
    const std::vector<LinePlace>& places = found->second;
    const auto behind =
        std::upper_bound(places.begin(), places.end(), line.begin.at,
                         [](std::size_t at, const LinePlace& place) { return at < place.at; });
    if (direction != "GOTOB" && behind != places.end()) return *behind;
    if (direction != "GOTOF" && behind != places.begin()) return *std::prev(behind);
    refuse(line, fmt::format("the label {} of the jump is not found in its direction", name));
  }

  /// FOR R1=1 TO 5: sets the variable before each pass. The loop ends behind the last value.
  FlowStep begin_count(const ControlLine& line) {
    const auto first = value_of(read_counted_loop(line).first).value;
    if (!first) refuse(line, fmt::format("the begin of FOR {} is not known from the text", line.condition));
    return count(line, *first);
  }

  FlowStep count_on(const ControlLine& end) {
    const ControlLine& line = partner(end);
    return count(line, value_of_counter(end, counter_of(line)) + 1);
  }

  double value_of_counter(const ControlLine& line, const std::string& name) const {
    const auto now = variables_.values.find(name);
    if (now == variables_.values.end()) refuse(line, "the variable of FOR is not known here");
    return now->second;
  }

  std::string counter_of(const ControlLine& line) const {
    const std::string name = variable_name(dialect_, read_counted_loop(line).counter);
    if (name.empty()) refuse(line, "the variable of FOR is an expression or belongs to the control");
    return name;
  }

  FlowStep count(const ControlLine& line, double value) {
    const CountedLoop loop = read_counted_loop(line);
    const auto last = value_of(loop.last).value;
    if (!last) refuse(line, fmt::format("the end of FOR {} is not known from the text", line.condition));
    const std::string name = counter_of(line);
    store(variables_, name, value);
    return {value_of_counter(line, name) > *last ? partner(line).behind : line.behind,
            fmt::format("{}={}", loop.counter, shortest_text(value))};
  }

  const ControlFlow& flow_;
  const Dialect& dialect_;
  LoopState& loops_;
  Variables& variables_;
};

}  // namespace

FlowStep follow(const ControlFlow& flow, const ControlLine& line, const Dialect& dialect, LoopState& loops,
                Variables& variables) {
  return Follower(flow, dialect, loops, variables).step(line);
}

}  // namespace counterflex
