#include "report/text/offsets_text.hpp"

#include <fmt/format.h>

#include "counterflex/report/page.hpp"
#include "report/plot/svg.hpp"
#include "report/text/report_text.hpp"

namespace counterflex {
namespace {

constexpr std::string_view offsets_title = "Best constant offsets";

std::string change_of(const BestOffsets::OfTool& tool) {
  std::string text = tool.tool == 0 ? "the tool without a number:" : fmt::format("T{}:", tool.tool);
  const auto add = [&](const char* what, const std::optional<double>& mm) {
    if (mm) text += fmt::format(" {} {}{} mm", what, *mm > 0 ? "+" : "", mm4(*mm));
  };
  add("length", tool.length_mm);
  add("radius", tool.radius_mm);
  return text;
}

}  // namespace

std::vector<ChangeInWords> changes_in_words(const BestOffsets& best) {
  std::vector<ChangeInWords> rows;
  for (const BestOffsets::OfWork& of : best.work)
    rows.push_back({fmt::format("{}: add {}", of.work.empty() ? "base" : of.work, of.change), of.words});
  for (const BestOffsets::OfTool& tool : best.tools) rows.push_back({change_of(tool), tool.words});
  return rows;
}

std::string rest_in_words(const BestOffsets& best, double tolerance_mm) {
  std::string text = fmt::format("leaves {}{} mm of {}", mm4(best.rest.max_mm), band_text(best.rest),
                                 mm4(best.before.max_mm));
  if (best.before.rms_mm && best.rest.rms_mm)
    text += fmt::format(" (rms {} of {})", mm4(*best.rest.rms_mm), mm4(*best.before.rms_mm));
  text += fmt::format(", line {}", best.rest.max_line);
  if (best.is_enough)
    return text +
           fmt::format("; within the tolerance of {} mm: no corrected program is needed", mm4(tolerance_mm));
  return text +
         (best.rest.max_mm > tolerance_mm
              ? fmt::format("; more than the tolerance of {} mm: compensate the program", mm4(tolerance_mm))
              : "; moves without a known deviation, or the tilt of the tool, may miss the tolerance: "
                "compensate the program");
}

std::vector<std::string> remarks_in_words(const BestOffsets& best) {
  std::vector<std::string> remarks;
  if (best.work.size() > 1)
    for (const BestOffsets::OfWork& of : best.work)
      remarks.push_back(fmt::format("{}: largest {} mm, with the shifts {} mm", of.work, mm4(of.before_mm),
                                    mm4(of.rest_mm)));
  remarks.push_back(fmt::format("the least largest deviation of exact numbers is {} mm", mm4(best.least_mm)));
  remarks.insert(remarks.end(), best.notes.begin(), best.notes.end());
  return remarks;
}

std::string offsets_text(const RunReport& report, const Ink& ink) {
  const auto& best = report.best_offsets;
  if (!best) return "";
  std::string text =
      line_break() + ink.bold(std::string(offsets_title)) + ", added to the values of the control\n";
  for (const ChangeInWords& row : changes_in_words(*best)) {
    text += wrapped("  ", row.change, 4);
    for (const std::string& words : row.words) text += "    " + without_controls(words) + "\n";
  }
  text += wrapped("  ", rest_in_words(*best, report.tolerance_mm), 4);
  for (const std::string& remark : remarks_in_words(*best)) text += wrapped("  ", remark, 4);
  return text;
}

std::string offsets_html(const RunReport& report) {
  const auto& best = report.best_offsets;
  if (!best) return "";
  const auto shown = [](const std::string& text) { return xml_escaped(without_controls(text)); };
  std::string html = fmt::format(
      "  <section id=\"offsets\" data-short=\"Offsets\" aria-labelledby=\"offsets-title\"><h2 "
      "id=\"offsets-title\">{}</h2><div class=\"place-card\">\n"
      "  <p>Added to the values of the control:</p>\n",
      offsets_title);
  for (const ChangeInWords& row : changes_in_words(*best)) {
    html += "  <p class=\"cause\">" + shown(row.change) + "</p>\n";
    if (row.words.empty()) continue;
    html += "  <pre><code>";
    for (const std::string& words : row.words) html += shown(words) + "\n";
    html += "</code></pre>\n";
  }
  html += "  <p>" + shown(rest_in_words(*best, report.tolerance_mm)) + "</p>\n  <ul>\n";
  for (const std::string& remark : remarks_in_words(*best)) html += "  <li>" + shown(remark) + "</li>\n";
  return html + "  </ul></div></section>\n";
}

}  // namespace counterflex
