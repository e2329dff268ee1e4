#include <fmt/format.h>

#include "counterflex/files/text.hpp"
#include "report/text/report_text.hpp"
#include "report/text/text_layout.hpp"

namespace counterflex {

std::string spin_words(const FreeSpin& spin) {
  const std::string programmed =
      fmt::format("largest deviation {} mm, line {}", mm4(spin.programmed_mm), spin.programmed_line);
  if (spin.turned == 0)
    return programmed + ": no turn about the spindle gains 1 %, the program is not turned";
  return programmed + fmt::format(
                          " -> {} mm, line {} by the turn about the spindle alone, before correction; {} to "
                          "{} deg, {} of {} targets turned",
                          mm4(spin.turned_mm), spin.turned_line, format_fixed(spin.least_deg, 0),
                          format_fixed(spin.most_deg, 0), spin.turned, spin.targets);
}

}  // namespace counterflex
