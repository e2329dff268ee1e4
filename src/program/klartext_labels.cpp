#include "program/klartext_labels.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "program/klartext_lex.hpp"

namespace counterflex {
namespace {

struct Label {
  std::string name;
  int line;
};
struct Reference {
  std::string name;
  int line;
  bool subprogram;  ///< a call that returns
};
struct Labels {
  std::vector<Label> set;
  std::vector<Reference> used;
};

/// The name that `text` (squeezed) begins with: quoted, or digits; "Q..." stands for any.
std::string label_name(std::string_view text) {
  if (text.starts_with('"')) return std::string(text.substr(0, text.find('"', 1)));
  std::size_t end = 0;
  while (end < text.size() && text[end] >= '0' && text[end] <= '9') ++end;
  return end > 0 ? std::string(text.substr(0, end)) : "Q";
}

Labels find_labels(std::string_view text) {
  Labels labels;
  KlartextBlock block;
  while (next_klartext_block(text, block)) {
    if (block.head != "LBL" && block.head != "CALL" && block.head != "FN" && block.head != "IF") continue;
    const std::string rest = squeezed(after_head(text, block));
    if (block.head == "LBL") {
      labels.set.push_back({label_name(rest), block.line});
    } else if (block.head == "CALL" && rest.starts_with("LBL")) {
      labels.used.push_back({label_name(rest.substr(3)), block.line, rest.find("REP") == std::string::npos});
    } else if (const std::size_t jump = rest.find("GOTOLBL"); jump != std::string::npos) {
      labels.used.push_back({label_name(rest.substr(jump + 7)), block.line, false});
    }
  }
  return labels;
}

int end_of_body(const Labels& labels, int first) {
  for (const Label& label : labels.set)
    if (label.line > first && label.name == "0") return label.line;
  return std::numeric_limits<int>::max();
}

std::vector<LineStretch> merged(std::vector<LineStretch> stretches) {
  std::sort(stretches.begin(), stretches.end(), [](auto& a, auto& b) { return a.first < b.first; });
  std::vector<LineStretch> result;
  for (const LineStretch& stretch : stretches)
    if (!result.empty() && stretch.first <= result.back().last)
      result.back().last = std::max(result.back().last, stretch.last);
    else
      result.push_back(stretch);
  return result;
}

}  // namespace

std::vector<LineStretch> doubtful_stretches(std::string_view text) {
  const Labels labels = find_labels(text);
  std::vector<LineStretch> stretches;
  for (const Reference& used : labels.used) {
    if (used.name == "Q") return {{0, std::numeric_limits<int>::max()}};
    for (const Label& label : labels.set) {
      if (label.name != used.name) continue;
      const int last = used.subprogram ? end_of_body(labels, label.line) : std::max(label.line, used.line);
      stretches.push_back({used.subprogram ? label.line : std::min(label.line, used.line), last});
    }
  }
  return merged(std::move(stretches));
}

bool holds(const std::vector<LineStretch>& stretches, int line) {
  const auto after = std::upper_bound(stretches.begin(), stretches.end(), line,
                                      [](int wanted, const LineStretch& s) { return wanted < s.first; });
  return after != stretches.begin() && (after - 1)->last >= line;
}

std::vector<int> poles_used_otherwise(std::string_view text) {
  constexpr std::array<std::string_view, 8> polar{"LP", "CP", "CTP", "FPOL", "FL", "FC", "FLT", "FCT"};
  std::vector<int> lines;
  int pole = 0;
  KlartextBlock block;
  while (next_klartext_block(text, block)) {
    if (block.head == "CC") pole = block.line;
    const bool approach =
        (block.head == "APPR" || block.head == "DEP") && squeezed(after_head(text, block)).starts_with("P");
    const bool uses = approach || std::find(polar.begin(), polar.end(), block.head) != polar.end();
    if (uses && pole > 0 && (lines.empty() || lines.back() != pole)) lines.push_back(pole);
  }
  return lines;
}

}  // namespace counterflex
