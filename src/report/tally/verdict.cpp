#include <fmt/format.h>

#include <cmath>

#include "counterflex/files/text.hpp"
#include "counterflex/report/statistics.hpp"
#include "report/text/text_layout.hpp"

namespace counterflex {
namespace {

/// Never "100 %" unless it is all, nor "0 %" unless it is zero.
// Lengths are sums in different orders: a part that differs from the whole by rounding is the whole.
bool is_whole(double part, double all) {
  return part >= (1 - 1e-9) * all;
}

std::string percent_text(double part, double all) {
  const double percent = 100 * part / all;
  if (is_whole(part, all) || percent == 0) return fmt::format("{:.0f} %", percent);
  if (percent > 1 && percent < 99) return fmt::format("{:.0f} %", percent);
  if (percent < 0.1) return "less than 0.1 %";
  return fmt::format("{} %", format_fixed(std::floor(10 * percent) / 10, 1));
}

/// With enough digits to differ from the tolerance.
std::string above_text(double worst_mm, double tolerance_mm) {
  const std::string tolerance = fmt::format("{:.6g}", tolerance_mm);
  return fmt::format("worst {} mm > {}", format_beside(worst_mm, tolerance_mm, 4), tolerance);
}

}  // namespace

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::ok:
      return "OK";
    case Verdict::predicted:
      return "PREDICTED";
    case Verdict::partly:
      return "PARTLY";
    case Verdict::nothing_corrected:
      return "NOTHING CORRECTED";
    case Verdict::failed:
      return "FAILED";
  }
  return "FAILED";
}

Verdict verdict_of(const FeedMoves& moves) {
  const bool any = moves.within > 0 || moves.missed > 0 || moves.known_ends > 0;
  const bool only_rapids = moves.count == 0 && moves.rapid_ends > 0;
  if (!any && !only_rapids) return Verdict::nothing_corrected;
  return moves.missed > 0 || moves.unknown > 0 ? Verdict::partly : Verdict::ok;
}

std::string partly_reason(const FeedMoves& moves, double tolerance_mm) {
  std::string text;
  const auto add = [&](const std::string& part) { text.append(text.empty() ? "" : ", ").append(part); };
  if (moves.length_mm > 0)
    add(fmt::format("{} of the {}cutting length", percent_text(moves.within_mm, moves.length_mm),
                    moves.unknown_length > 0 ? "known " : ""));
  else
    add(fmt::format("{} of {}", moves.within, counted(moves.count, "feed move")));
  if (moves.missed > 0 && is_whole(moves.within_mm, moves.length_mm))
    add(fmt::format("{} above the tolerance", counted(moves.missed, "feed move")));
  if (moves.missed > 0) add(above_text(moves.worst_mm, tolerance_mm));
  const std::size_t unsolved = moves.unknown - moves.unknown_length;
  if (unsolved > 0) add(fmt::format("{} of unknown deviation", counted(unsolved, "feed move")));
  if (moves.unknown_length > 0)
    add(fmt::format("{} of unknown length", counted(moves.unknown_length, "feed move")));
  return text;
}

std::string verdict_text(Verdict verdict, std::string_view reason) {
  if (verdict != Verdict::partly || reason.empty()) return std::string(to_string(verdict));
  return fmt::format("{} ({})", to_string(verdict), reason);
}

}  // namespace counterflex
