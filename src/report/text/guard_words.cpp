#include <fmt/format.h>

#include "report/text/report_text.hpp"

namespace counterflex {

std::string guard_words(const WrittenGuard& written) {
  const Guard& guard = written.guard;
  const Vector3& p = guard.active.shown_mm;
  std::string text =
      fmt::format("before line {}: {} X {} Y {} Z {}", written.line,
                  guard.active.name.empty() ? "world frame" : guard.active.name, p.x(), p.y(), p.z());
  if (guard.length_mm)
    text += fmt::format(", T{} length {}", guard.tool, *guard.length_mm);
  else if (guard.tool > 0)
    text += fmt::format(", T{}", guard.tool);
  return text + fmt::format("; each within {} mm, solved at {} places", guard.window_mm, written.places);
}

}  // namespace counterflex
