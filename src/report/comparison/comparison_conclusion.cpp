#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "counterflex/geometry/types.hpp"
#include "report/comparison/comparison_parts.hpp"

namespace counterflex {

namespace {

/// Lengths in the unit of both reports.
struct ShownLength {
  std::string unit;
  bool utf8;  ///< the reader shows "µm"

  std::string operator()(double value_mm) const {
    if (unit == "um") return format_fixed(value_mm * 1000, 1) + (utf8 ? " \u00b5m" : " um");
    if (unit == "inch") return format_fixed(value_mm * (mm / inch), 5) + " inch";
    return format_fixed(value_mm, 4) + " mm";
  }
  bool alike(double a_mm, double b_mm) const { return (*this)(std::abs(b_mm - a_mm)) == (*this)(0); }
};

using TwoValues = std::array<std::optional<double>, 2>;

TwoValues values_of(const Comparison& comparison, const std::string& key) {
  for (const ComparedNumber& number : comparison.numbers)
    if (number.key == key) return number.values;
  return {};
}

std::string of_residuals(const Comparison& c, double a, double b, const ShownLength& length) {
  const std::string &name_a = c.runs[0].name, &name_b = c.runs[1].name;
  if (length.alike(a, b))
    return fmt::format("{} and {} have the same largest model residual: {}.", name_a, name_b, length(b));
  return fmt::format("{} leaves {} {} than {}: a largest model residual of {} instead of {}.", name_b,
                     length(std::abs(b - a)), b < a ? "less" : "more", name_a, length(b), length(a));
}

std::string of_deviations(const Comparison& c, double a, double b, const ShownLength& length) {
  const std::string &name_a = c.runs[0].name, &name_b = c.runs[1].name;
  if (length.alike(a, b))
    return fmt::format("Uncorrected, {} and {} are off by the same amount, by up to {}.", name_a, name_b,
                       length(b));
  return fmt::format("Uncorrected, {} is off by up to {}, {} {} than {}.", name_b, length(b),
                     length(std::abs(b - a)), b < a ? "less" : "more", name_a);
}

/// For two runs of which one has no residual.
std::string of_unlike(const Comparison& c, const TwoValues& before, const TwoValues& after,
                      const ShownLength& length) {
  const std::size_t with = after[0] ? 0 : 1, without = 1 - with;
  const ComparedRun& other = c.runs[without];
  std::string text =
      fmt::format("{} leaves a largest model residual of {}", c.runs[with].name, length(*after[with]));
  if (!before[without]) return text + ".";
  const char* why = other.command == "predict" ? ", which corrects nothing," : "";
  return text + fmt::format("; {}{} is off by up to {}.", other.name, why, length(*before[without]));
}

std::string main_sentence(const Comparison& c, const ShownLength& length) {
  const TwoValues before = values_of(c, "/summary/before/max_mm"),
                  after = values_of(c, "/summary/after/max_mm");
  if (after[0] && after[1]) {
    std::string text = of_residuals(c, *after[0], *after[1], length);
    if (before[0] && before[1] && !length.alike(*before[0], *before[1]))
      text += " " + of_deviations(c, *before[0], *before[1], length);
    return text;
  }
  if (after[0] || after[1]) return of_unlike(c, before, after, length);
  if (before[0] && before[1]) return of_deviations(c, *before[0], *before[1], length);
  return "There is no deviation to compare.";
}

}  // namespace

std::string conclusion_of(const Comparison& comparison, bool utf8) {
  std::string text = main_sentence(comparison, ShownLength{comparison.unit, utf8});
  const TwoValues before = values_of(comparison, "/summary/before/max_mm");
  for (std::size_t i = 0; i < before.size(); ++i)
    if (const ComparedRun& run = comparison.runs[i]; !run.failure.empty())
      text += before[i]
                  ? fmt::format(" {} failed: its numbers are those of the part that was solved.", run.name)
                  : fmt::format(" {} failed: its report has no deviations to compare.", run.name);
  const auto& differences = comparison.differences;
  if (std::any_of(differences.begin(), differences.end(),
                  [](const RunDifference& d) { return d.what == "file: program"; }))
    text += " The programs are different.";
  return text;
}

}  // namespace counterflex
