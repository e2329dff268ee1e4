#include "commands/forces_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "counterflex/files/input_error.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex::cli {
namespace {

constexpr int force_decimals = 6, length_decimals = 9;  // of the profile: N, N m and mm

// Of two forces of equal size the first is the largest, however their axes turn.
constexpr double rounding = 1e-9;

std::string moves_text(const ForceTotals::Sum& sum) {
  std::string text = fmt::format("{} feed move{}", sum.moves, sum.moves == 1 ? "" : "s");
  if (sum.moves == 0 || sum.moves > sum.unknown) text += fmt::format(", {:.3f} mm", sum.length / mm);
  if (sum.unknown > 0) text += fmt::format(", {} of unknown length", sum.unknown);
  return text;
}

nlohmann::ordered_json sum_json(const ForceTotals::Sum& sum) {
  const bool unknown = sum.moves > 0 && sum.unknown == sum.moves;
  nlohmann::ordered_json json{{"moves", sum.moves}, {"length_mm", nullptr}};
  if (!unknown) json["length_mm"] = rounded(sum.length / mm, 6);
  return json;
}

nlohmann::ordered_json number_if_known(double length_mm) {
  if (std::isnan(length_mm)) return nullptr;
  return rounded(length_mm, 6);
}

nlohmann::ordered_json number_or_null(double value, int decimals) {
  if (value == 0) return nullptr;
  return rounded(value, decimals);
}

constexpr std::string_view instead = "give the other commands the same forces as this one, or use --json";

/// Throws if a profile of steps in the feed frame cannot represent the force of a move.
void refuse_move(const std::string& program, const MoveForce& move) {
  const auto refuse = [&](ErrorKind kind, const std::string& why) {
    throw InputError(kind, {program, move.line, 1}, why);
  };
  if (move.comment_altered)
    refuse(ErrorKind::usage,
           "a FORCE comment gives the force of this move; --load-scale and --air-above cannot change it in a "
           "profile: give them to the command that reads the profile");
  if (move.comment) return;
  if (move.only_z)
    refuse(ErrorKind::machine_or_force,
           fmt::format("the {} {:.6g} N is not{}: a profile in the feed frame cannot represent it; {}",
                       move.length > 0 ? "feed is parallel to the tool axis, and the force of"
                                       : "block only turns the tool, and the force of",
                       move.largest_N, move.length > 0 ? "" : " parallel to the tool axis", instead));
  if (move.steps.empty())
    refuse(ErrorKind::machine_or_force,
           fmt::format("the force, {:.6g} N at most, changes along this move: a "
                       "profile of steps in the feed frame cannot represent it; {}",
                       move.largest_N, instead));
}

/// As cells of a row, each after a comma.
std::string cells_of(std::initializer_list<double> numbers) {
  std::string text;
  for (const double number : numbers) text += ", " + format_fixed(number, force_decimals);
  return text;
}

}  // namespace

void add(const MoveForce& move, ForceTotals& totals) {
  const auto count = [&](ForceTotals::Sum& sum) {
    ++sum.moves;
    if (std::isnan(move.length))
      ++sum.unknown;
    else
      sum.length += move.length;
  };
  if (!move.why.empty()) {
    count(totals.without);
    return count(totals.why[move.why]);
  }
  count(totals.with);
  totals.only_z += move.only_z;
  totals.changing += move.changes;
  if (move.largest_N <= totals.largest_N * (1 + rounding)) return;
  totals.largest_N = move.largest_N;
  totals.largest_line = move.line;
}

std::string table_head(const std::string& program, bool at_platform) {
  return fmt::format(
      "forces of {}\n"
      "{}, in the middle of every feed move, in the feed frame: x along the feed, z from tip to "
      "spindle\n\n"
      "{:>7} {:>5} {:>11} {:>9} {:>7} {:>8} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n",
      program, at_platform ? "at the platform's reference point (at = platform)" : "on the tool", "line",
      "tool", "length_mm", "mm_min", "S", "fz_mm", "fx_N", "fy_N", "fz_N", "mx_Nm", "my_Nm", "mz_Nm");
}

std::string table_row(const MoveForce& move) {
  const auto if_known = [](double number) { return number == 0 ? "-" : fmt::format("{:.6g}", number); };
  std::string text = fmt::format("{:>7} {:>5} {:>11} {:>9} {:>7} ", move.line,
                                 move.tool == 0 ? "-" : fmt::format("T{}", move.tool),
                                 std::isnan(move.length) ? "-" : fmt::format("{:.3f}", move.length / mm),
                                 if_known(move.feed_m_s / mm * 60), if_known(move.spindle_rpm));
  text += move.feed_per_tooth == 0 ? fmt::format("{:>8}", "-")
                                   : fmt::format("{:>8.4f}", move.feed_per_tooth / mm);
  if (!move.why.empty()) return text + "   none: " + move.why + "\n";
  for (int i = 0; i < 6; ++i) text += " " + fmt::format("{:>9}", format_fixed(move.F[i], i < 3 ? 2 : 4));
  if (move.only_z) text += "  along the tool only";
  if (move.changes) text += "  changes along the move";
  return text + "\n";
}

std::string table_foot(const ForceTotals& totals) {
  std::string text = fmt::format("\nwith a force     {}\n", moves_text(totals.with));
  if (totals.largest_N > 0)
    text += fmt::format("  largest force  {:.1f} N, line {}\n", totals.largest_N, totals.largest_line);
  if (totals.only_z > 0)
    text += fmt::format(
        "  {} of them along the tool, or only turning it: the lateral direction is undefined, and only the "
        "component along the tool is shown\n",
        totals.only_z);
  if (totals.changing > 0)
    text += fmt::format(
        "  the force changes along {} of them: the table shows the force in the middle, which may not be the "
        "largest\n",
        totals.changing);
  text += fmt::format("without a force  {}\n", moves_text(totals.without));
  for (const auto& [why, sum] : totals.why) text += fmt::format("  {}: {}\n", why, moves_text(sum));
  return text;
}

std::string json_head(const std::string& program, bool at_platform) {
  return fmt::format("{{\n  \"schema\": \"counterflex-move-forces 1\",\n  \"program\": {},\n{}  \"moves\": [",
                     nlohmann::json(program).dump(), at_platform ? "  \"wrench_at\": \"platform\",\n" : "");
}

std::string json_row(const MoveForce& move, bool first) {
  nlohmann::ordered_json json{{"line", move.line},
                              {"tool", move.tool},
                              {"s_mm", number_if_known(move.s_start / mm)},
                              {"length_mm", number_if_known(move.length / mm)},
                              {"feed_mm_min", number_or_null(move.feed_m_s / mm * 60, 6)},
                              {"spindle_rpm", number_or_null(move.spindle_rpm, 6)},
                              {"feed_per_tooth_mm", number_or_null(move.feed_per_tooth / mm, 9)}};
  if (move.why.empty()) {
    auto& wrench = json["wrench_N_Nm"] = nlohmann::ordered_json::array();
    for (int i = 0; i < 6; ++i) wrench.push_back(rounded(move.F[i], force_decimals));
    json["along_tool_only"] = move.only_z;
    json["changes_along_move"] = move.changes;
    json["largest_N"] = rounded(move.largest_N, force_decimals);
  } else {
    json["why"] = move.why;
  }
  return (first ? "\n    " : ",\n    ") + json.dump();
}

std::string json_foot(const ForceTotals& totals) {
  nlohmann::ordered_json reasons = nlohmann::ordered_json::array();
  for (const auto& [why, sum] : totals.why) {
    nlohmann::ordered_json entry{{"why", why}};
    entry.update(sum_json(sum));
    reasons.push_back(entry);
  }
  nlohmann::ordered_json json = sum_json(totals.with);
  json["largest_N"] = rounded(totals.largest_N, force_decimals);
  json["largest_line"] = totals.largest_line;
  return fmt::format("\n  ],\n  \"with_force\": {},\n  \"without_force\": {},\n  \"reasons\": {}\n}}\n",
                     json.dump(), sum_json(totals.without).dump(), reasons.dump());
}

std::string profile_head(const std::string& program, bool at_platform) {
  return fmt::format(
      "{}{}, a row a feed move, and one where the force steps within it;\n"
      "# zeros where none acts, nothing where a FORCE comment does.\n"
      "# frame = feed\n# sense = on_tool\n# at = {}\n# interpolation = step\n"
      "s_mm, fx_N, fy_N, fz_N, mx_Nm, my_Nm, mz_Nm\n",
      profile_mark, program, at_platform ? "platform" : "tip");
}

std::string profile_rows(const std::string& program, const MoveForce& move, ProfileEnd& end) {
  refuse_move(program, move);
  const bool turns = move.length == 0;
  std::string text;
  const auto add = [&](double s, const std::string& axial, const std::string& row) {
    const int turn_line = turns ? move.line : end.turn_line;
    if (turn_line > 0 && end.axial && axial != *end.axial)
      throw InputError(ErrorKind::machine_or_force, {program, turn_line, 1},
                       fmt::format("the block only turns the tool, and its force differs from that of the "
                                   "block beside it: a profile by path length cannot represent it; {}",
                                   instead));
    end.axial = axial;
    end.turn_line = turns ? move.line : 0;
    if (!turns) text += format_fixed(s / mm, length_decimals) + row + "\n";
  };
  if (move.comment) {
    add(move.s_start, "", ", , , , , ,");
    return text;
  }
  for (const auto& [s, F] : move.steps)
    add(s, cells_of({F[2], F[5]}), cells_of({F[0], F[1], F[2], F[3], F[4], F[5]}));
  return text;
}

}  // namespace counterflex::cli
