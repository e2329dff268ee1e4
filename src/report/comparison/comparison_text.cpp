#include <fmt/core.h>

#include <cmath>

#include "counterflex/files/text.hpp"
#include "counterflex/report/comparison.hpp"
#include "report/comparison/comparison_parts.hpp"
#include "report/text/text_layout.hpp"

namespace counterflex {

namespace {

constexpr std::size_t label_width = 36;

std::string number_or_dash(const std::optional<double>& value, int decimals) {
  return value ? format_fixed(*value, decimals) : "-";
}

std::string with_sign(double value, int decimals) {
  const std::string text = format_fixed(value, decimals);
  return value > 0 && text != format_fixed(0, decimals) ? "+" + text : text;
}

/// The change in percent; empty if it is too small to show or too large to be useful.
std::string percent_text(const ComparedNumber& number) {
  constexpr double most = 1000;
  const auto percent = number.percent();
  if (!percent || std::abs(*percent) >= most) return "";
  const std::string text = with_sign(*percent, 1);
  const bool shows = with_sign(*number.difference(), number.decimals) != format_fixed(0, number.decimals);
  return shows && text != "0.0" ? text + " %" : "";
}

std::string cells(const std::string& label, const std::string& a, const std::string& b, const std::string& c,
                  const std::string& d) {
  // If the words are longer than their column, the numbers are in the next line.
  const std::string shown = without_controls(label);
  std::string text = "  " + shown;
  if (shown.size() >= label_width)
    text += line_break() + std::string(2 + label_width, ' ');
  else
    text.append(label_width - shown.size(), ' ');
  text += fmt::format("{:>12}{:>12}{:>12}{:>12}", a, b, c, d);
  text.erase(text.find_last_not_of(' ') + 1);
  return text + line_break();
}

std::string number_cells(const ComparedNumber& number) {
  const auto difference = number.difference();
  return cells(number.label, number_or_dash(number.values[0], number.decimals),
               number_or_dash(number.values[1], number.decimals),
               difference ? with_sign(*difference, number.decimals) : "-", percent_text(number));
}

std::string number_tables(const Comparison& comparison, const Ink& ink) {
  std::string text;
  std::string heading;
  for (const ComparedNumber& number : comparison.numbers) {
    if (number.heading != heading) {
      heading = number.heading;
      const bool deviations = number.label == "largest" || number.key.find("/max_mm") != std::string::npos;
      text +=
          line_break() + ink.bold(without_controls(heading)) + (deviations ? ", in mm" : "") + line_break();
      text += cells("", "A", "B", "B - A", "");
    }
    text += number_cells(number);
  }
  return text;
}

std::string run_text(const ComparedRun& run, const char* letter) {
  std::string what = run.command + " " + run.program;
  what += " on " + (run.machine.empty() ? "an unnamed machine" : run.machine);
  if (!run.method.empty()) what += ", method " + run.method;
  if (run.tolerance_mm) what += ", tolerance " + mm4(*run.tolerance_mm) + " mm";
  std::string text = wrapped(fmt::format("  {}  ", letter), run.name + ": " + what, 5);
  if (!run.failure.empty()) text += wrapped("     failed: ", run.failure, 5);
  return text;
}

std::string operations_table(const Comparison& comparison, const Ink& ink) {
  if (comparison.operations.size() < 2) return "";
  std::string text =
      line_break() + ink.bold("By tool and operation") + ", largest deviation in mm" + line_break();
  text += cells("", "A before", "B before", "A after", "B after");
  for (const ComparedOperation& row : comparison.operations) {
    std::string label = row.tool.value_or(0) > 0 ? fmt::format("T{:.0f} ", *row.tool) : "";
    label += row.operation.empty() ? "no name" : row.operation;
    text += cells(label, number_or_dash(row.before_mm[0], 4), number_or_dash(row.before_mm[1], 4),
                  number_or_dash(row.after_mm[0], 4), number_or_dash(row.after_mm[1], 4));
  }
  return text;
}

std::string joined_words(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string differences_text(const Comparison& comparison, const Ink& ink) {
  std::string text = line_break() + ink.bold("What differs") + line_break();
  if (comparison.differences.empty()) text += "  Nothing: inputs and options are the same.\n";
  for (const RunDifference& difference : comparison.differences) {
    text += wrapped("  ", difference.what, 2);
    for (std::size_t i = 0; i < 2; ++i)
      text += wrapped(i == 0 ? "    A  " : "    B  ",
                      difference.values[i].empty() ? "-" : difference.values[i], 7);
  }
  if (!comparison.differences.empty() && !comparison.same.empty())
    text += wrapped("  ", "The same files: " + joined_words(comparison.same), 4);
  return text;
}

}  // namespace

std::string to_text(const Comparison& comparison, bool colour, bool marks) {
  const Ink ink{colour};
  std::string text = ink.bold("compare") + line_break();
  text += run_text(comparison.runs[0], "A") + run_text(comparison.runs[1], "B");
  text += number_tables(comparison, ink) + operations_table(comparison, ink);
  text += differences_text(comparison, ink);
  return text + line_break() + wrapped("", conclusion_of(comparison, marks), 0);
}

}  // namespace counterflex
