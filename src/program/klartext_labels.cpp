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

/// Whether a block counts from the pole in another way than C and CP do.
bool uses_pole(std::string_view text, const KlartextBlock& block) {
  constexpr std::array<std::string_view, 7> polar{"LP", "CTP", "FPOL", "FL", "FC", "FLT", "FCT"};
  const bool approach =
      (block.head == "APPR" || block.head == "DEP") && squeezed(after_head(text, block)).starts_with("P");
  return approach || std::find(polar.begin(), polar.end(), block.head) != polar.end();
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
  std::vector<int> lines;
  int pole = 0, arcs = 0, polar_arcs = 0, others = 0;
  const auto end_pole = [&] {
    const bool used_otherwise = others > 0 || polar_arcs > 1 || (polar_arcs == 1 && arcs > 0);
    if (pole > 0 && used_otherwise) lines.push_back(pole);
    arcs = polar_arcs = others = 0;
  };
  KlartextBlock block;
  while (next_klartext_block(text, block)) {
    if (block.head == "CC") end_pole(), pole = block.line;
    arcs += block.head == "C";
    polar_arcs += block.head == "CP";
    others += uses_pole(text, block);
  }
  end_pole();
  return lines;
}

}  // namespace counterflex
