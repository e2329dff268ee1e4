#pragma once
/// The best work offsets and tool data in words.
#include <string>
#include <vector>

#include "counterflex/report/report.hpp"
#include "report/text/text_layout.hpp"

namespace counterflex {

/// A work offset or a tool: what is added, and the words of the control, which stay whole.
struct ChangeInWords {
  std::string change;              ///< "G54: add X-0.041 Y+0.012 mm"
  std::vector<std::string> words;  ///< "G10 L2 P1 X149.959 Y100.012"
};
std::vector<ChangeInWords> changes_in_words(const BestOffsets& best);

/// "leaves 0.0041 mm of 0.0512 mm, ...: no corrected program is needed".
std::string rest_in_words(const BestOffsets& best, double tolerance_mm);

/// Sentences about each of several offsets, the exact numbers, and what was not changed.
std::vector<std::string> remarks_in_words(const BestOffsets& best);

/// The section of all details; empty without offsets.
std::string offsets_text(const RunReport& report, const Ink& ink);

}  // namespace counterflex
