#pragma once
/// Parts that the summary and the details of a run share.
#include <string>
#include <string_view>

#include "counterflex/report/report.hpp"
#include "report/text/text_layout.hpp"

namespace counterflex {

/// "verify B.ngc for A.ngc".
std::string what_was_done(const RunReport& report);

/// "Mill", "Mill at 25 degrees Celsius" where a temperature is given.
std::string machine_in_words(const RunReport& report);

/// The verdict in its colour, with a newline.
std::string verdict_line(const RunReport& report, const Ink& ink);

/// The handling of moves that are not corrected individually; empty without such moves.
std::string others_text(const OtherMoves& moves);

/// What is done to moves: with --only-significant some are followed and not corrected.
std::string_view done_word(const RunReport& report);

/// " +- 0.0120": the band of the largest deviation; empty without bands.
std::string band_text(const DeviationStatistics& s);

/// What the guard of the corrected program compares.
std::string guard_words(const WrittenGuard& written);

/// "12 of 40 targets and 31 % of the feed length as programmed, ...": what --only-significant leaves.
std::string as_programmed_words(const AsProgrammed& found);

/// "largest deviation 1.9300 mm, line 9 -> 1.4100 mm, ...": what the turn about the spindle buys.
std::string spin_words(const FreeSpin& spin);

}  // namespace counterflex
