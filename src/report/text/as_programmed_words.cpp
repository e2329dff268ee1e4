#include <fmt/format.h>

#include "counterflex/files/text.hpp"
#include "report/text/report_text.hpp"
#include "report/text/text_layout.hpp"

namespace counterflex {

std::string as_programmed_words(const AsProgrammed& found) {
  if (found.left == 0) return "no target as programmed: each has a deviation above its band beside it";
  std::string text = fmt::format("{} of {} targets", found.left, found.targets);
  if (found.length_mm > 0)
    text +=
        fmt::format(" and {} % of the feed length", format_fixed(100 * found.left_mm / found.length_mm, 0));
  text += " as programmed, because the deviation is below its band";
  if (found.largest_line > 0)
    text += fmt::format("; largest deviation left {} mm +- {}, line {}", mm4(found.largest_mm),
                        mm4(found.band_mm), found.largest_line);
  return text;
}

}  // namespace counterflex
