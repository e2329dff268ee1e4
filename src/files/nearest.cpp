#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include "counterflex/files/text.hpp"

namespace counterflex {
namespace {

/// The Levenshtein distance.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = std::exchange(row[j + 1], std::min({replaced, row[j] + 1, row[j + 1] + 1}));
    }
  }
  return row.back();
}

std::string_view stem(std::string_view name) {
  return name.substr(0, name.find('_'));
}

std::size_t common_beginning(std::string_view a, std::string_view b) {
  return static_cast<std::size_t>(std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin());
}

}  // namespace

std::string_view nearest(std::string_view name, const std::vector<std::string_view>& known) {
  const std::size_t tolerated = std::min<std::size_t>(3, (name.size() + 2) / 3);
  std::string_view best;
  std::size_t fewest = tolerated + 1;
  for (const std::string_view candidate : known) {
    const std::size_t distance = edits(name, candidate);
    if (distance < fewest && distance < candidate.size()) {
      fewest = distance;
      best = candidate;
    }
  }
  if (!best.empty()) return best;
  std::size_t longest = 0;
  for (const std::string_view candidate : known) {
    const bool same_stem = candidate.find('_') != std::string_view::npos && stem(candidate) == stem(name);
    if (!same_stem || common_beginning(name, candidate) <= longest) continue;
    longest = common_beginning(name, candidate);
    best = candidate;
  }
  return best;
}

}  // namespace counterflex
