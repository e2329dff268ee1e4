#pragma once
/// The comments that a corrected program begins with.
#include <string>
#include <string_view>
#include <vector>

#include "run/run.hpp"

namespace counterflex::cli {

/// Their texts, each beginning "COUNTERFLEX 1": the version, the hashes of the inputs, and in words for the
/// setter the machine, the work offsets, the tools and the forces for which the program was made. Capital
/// letters, digits and signs that every control reads in a comment.
std::vector<std::string> header_of(const Options& options, const Run& run);

/// What the text of a program does not say of how it is read: verify needs what compensate had.
struct ReadingWord {
  bool acts;
  std::string_view in_header, option;
};
std::vector<ReadingWord> reading_words(const ReadOptions& read);

/// Of --force: "T3=1,2,3,0,0,0".
std::string force_rule_text(const ForceRule& rule);

}  // namespace counterflex::cli
