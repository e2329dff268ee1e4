#pragma once
/// The comments at the beginning of a corrected program.
#include <string>
#include <string_view>
#include <vector>

#include "run/run.hpp"

namespace counterflex::cli {

/// Their texts, each beginning with "COUNTERFLEX 1": version, hashes of the inputs and, in words for the
/// operator, machine, work offsets, tools and forces. Only capital letters, digits and signs that every
/// control allows in comments.
std::vector<std::string> header_of(const Options& options, const Run& run);

/// Of a program in which not all is corrected: `verify` needs the option, too.
inline constexpr std::string_view only_significant_mark = "ONLY SIGNIFICANT";

/// Options of reading that the text of a program does not show: `verify` needs those of `compensate`.
struct ReadingWord {
  bool acts;
  std::string_view in_header, option;
};
std::vector<ReadingWord> reading_words(const ReadOptions& read);

/// Of --force: "T3=1,2,3,0,0,0".
std::string force_rule_text(const ForceRule& rule);

}  // namespace counterflex::cli
