#include "commands/check_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "commands/check.hpp"

namespace counterflex::cli {
std::size_t unknown_moves(const MotionPlan& plan) {
  return plan.corrected_cut.unknown + plan.held_cut.unknown + plan.grouped_cut.unknown +
         plan.left_cut.unknown;
}

namespace {

constexpr std::array plane_names{"XY", "XZ", "YZ"};

std::string lines_text(const PlanRow& row) {
  return fmt::format("line{} {}{}", row.count == 1 ? "" : "s", fmt::join(row.lines, ", "),
                     row.count > row.lines.size() ? ", ..." : "");
}

double known_mm(const MotionPlan& plan) {
  return plan.corrected_cut.known_mm + plan.held_cut.known_mm + plan.grouped_cut.known_mm +
         plan.left_cut.known_mm;
}

/// "12.5 %" of the known cutting length; "-" if no length is known.
std::string share_text(double length_mm, const MotionPlan& plan) {
  const double all = known_mm(plan);
  return all > 0 ? fmt::format("{:.1f} %", 100 * length_mm / all) : "-";
}

std::string counted_unknown(std::size_t moves) {
  return fmt::format("{} feed move{} of unknown length", moves, moves == 1 ? "" : "s");
}

std::string lengths_text(const MotionPlan& plan) {
  std::string text =
      fmt::format("{} corrected, {} held, {} in contour groups, {} not corrected",
                  share_text(plan.corrected_cut.known_mm, plan), share_text(plan.held_cut.known_mm, plan),
                  share_text(plan.grouped_cut.known_mm, plan), share_text(plan.left_cut.known_mm, plan));
  if (const std::size_t unknown = unknown_moves(plan); unknown > 0)
    text += ", besides " + counted_unknown(unknown);
  return text;
}

std::string cost_text(const PlanRow& row, const MotionPlan& plan) {
  std::string text;
  if (row.cut.known_mm > 0)
    text += fmt::format(" ({} of the cutting length)", share_text(row.cut.known_mm, plan));
  if (row.cut.unknown > 0) text += fmt::format(" ({})", counted_unknown(row.cut.unknown));
  return text;
}

std::string rows_text(std::string_view title, const std::vector<PlanRow>& rows, const MotionPlan& plan) {
  if (rows.empty()) return "";
  std::string text = fmt::format("\n{}\n", title);
  for (const PlanRow& row : rows)
    text += fmt::format("  {:>6}  {}: {}{}{}\n", row.count, lines_text(row), row.why, cost_text(row, plan),
                        row.must_be_zero ? "; refused unless its correction is zero" : "");
  return text;
}

std::string groups_text(const std::vector<PlanGroup>& groups) {
  if (groups.empty()) return "";
  std::string text = "\ncontour groups (G41, G42), one shift each\n";
  for (const PlanGroup& group : groups)
    text += fmt::format("  {:>6}  lines {} to {}\n", group.moves, group.first_line, group.last_line);
  return text;
}

std::string arcs_text(const MotionPlan& plan) {
  std::string text;
  for (std::size_t i = 0; i < plan.arcs.size(); ++i)
    if (plan.arcs[i] > 0)
      text += fmt::format("{}{} in {}", text.empty() ? "" : ", ", plan.arcs[i], plane_names[i]);
  return text;
}

constexpr std::size_t tools_shown = 6;

std::string tools_text(const MotionPlan& plan) {
  std::string text;
  std::size_t shown = 0;
  for (const auto& [tool, moves] : plan.tools) {
    if (++shown > tools_shown) return fmt::format("{} and {} more", text, plan.tools.size() - tools_shown);
    text += fmt::format("{}{} ({} move{})", text.empty() ? "" : ", ",
                        tool == 0 ? "none known" : fmt::format("T{}", tool), moves, moves == 1 ? "" : "s");
  }
  return text;
}

nlohmann::ordered_json rows_json(const std::vector<PlanRow>& rows) {
  auto list = nlohmann::ordered_json::array();
  for (const PlanRow& row : rows)
    list.push_back({{"why", row.why},
                    {"count", row.count},
                    {"cut_mm", row.cut.known_mm},
                    {"feed_moves_of_unknown_length", row.cut.unknown},
                    {"lines", row.lines},
                    {"refused_unless_zero", row.must_be_zero}});
  return list;
}

nlohmann::ordered_json groups_json(const std::vector<PlanGroup>& groups) {
  auto list = nlohmann::ordered_json::array();
  for (const PlanGroup& group : groups)
    list.push_back(
        {{"moves", group.moves}, {"first_line", group.first_line}, {"last_line", group.last_line}});
  return list;
}

}  // namespace

std::string plan_text(const MotionPlan& plan) {
  std::string text =
      row("plan", fmt::format("of {} blocks with motion {} corrected, {} held, {} in contour groups, "
                              "{} not corrected",
                              plan.moves, plan.corrected, plan.held, plan.grouped, plan.not_corrected));
  if (known_mm(plan) > 0 || unknown_moves(plan) > 0) text += row("by length", lengths_text(plan));
  if (const std::string arcs = arcs_text(plan); !arcs.empty()) text += row("arcs", arcs);
  if (plan.cycles > 0) text += row("cycles", fmt::format("{} holes", plan.cycles));
  if (plan.relative > 0) text += row("relative", fmt::format("{} moves in G91", plan.relative));
  if (plan.inverse_time > 0) text += row("feed mode", fmt::format("{} moves in G93", plan.inverse_time));
  if (plan.tools.size() > 1 || plan.tools.count(0) == 0) text += row("tools", tools_text(plan));
  return text + rows_text("held", plan.held_rows, plan) + groups_text(plan.groups) +
         rows_text("not corrected", plan.left_rows, plan) +
         rows_text("left as they are", plan.other_rows, plan);
}

nlohmann::ordered_json plan_json(const MotionPlan& plan) {
  auto arcs = nlohmann::ordered_json::object(), tools = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < plan.arcs.size(); ++i) arcs[plane_names[i]] = plan.arcs[i];
  for (const auto& [tool, moves] : plan.tools) tools[std::to_string(tool)] = moves;
  return {{"moves", plan.moves},
          {"corrected", plan.corrected},
          {"held", plan.held},
          {"grouped", plan.grouped},
          {"not_corrected", plan.not_corrected},
          {"cut_mm",
           {{"corrected", plan.corrected_cut.known_mm},
            {"held", plan.held_cut.known_mm},
            {"grouped", plan.grouped_cut.known_mm},
            {"not_corrected", plan.left_cut.known_mm}}},
          {"feed_moves_of_unknown_length", unknown_moves(plan)},
          {"held_rows", rows_json(plan.held_rows)},
          {"groups", groups_json(plan.groups)},
          {"not_corrected_rows", rows_json(plan.left_rows)},
          {"other_rows", rows_json(plan.other_rows)},
          {"arcs", arcs},
          {"cycles", plan.cycles},
          {"relative", plan.relative},
          {"inverse_time", plan.inverse_time},
          {"tools", tools}};
}

}  // namespace counterflex::cli
