#include "report/text/loads_text.hpp"

#include <fmt/core.h>

#include <cmath>

namespace counterflex {

namespace {

// The kind of load that is nearest to its limit, or exceeds it most; empty without limits.
std::optional<LoadKind> nearest_limit(const LoadsOfChain& chain) {
  std::optional<LoadKind> nearest;
  for (const LoadKind kind : load_kinds)
    if (chain[kind].limit && (!nearest || share_of_limit(chain[kind]) > share_of_limit(chain[*nearest])))
      nearest = kind;
  return nearest;
}

std::string chain_text(const LoadsOfChain& chain, LoadKind kind) {
  const LoadPeak& peak = chain[kind];
  std::string text = fmt::format("{}, {} % of {}", load_in_words(chain, kind),
                                 std::lround(100 * share_of_limit(peak)), limit_in_words(chain, kind));
  if (peak.line > 0) text += fmt::format(", line {}", peak.line);
  return wrapped("  ", text, 4);
}

}  // namespace

std::string loads_text(const RunReport& report, const Ink& ink) {
  if (!report.loads) return "";
  std::string text;
  for (const LoadsOfChain& chain : report.loads->chains)
    if (const std::optional<LoadKind> kind = nearest_limit(chain)) text += chain_text(chain, *kind);
  if (text.empty()) return text;
  const LoadsAlong& along = report.loads->along;
  const std::string places = counted(along.places.size(), "place");
  text = line_break() + ink.bold("Loads nearest to their limits") +
         fmt::format(", at {} of the path\n", places) + text;
  if (along.unsolved > 0) text += fmt::format("  unknown at {} more\n", counted(along.unsolved, "place"));
  return text;
}

}  // namespace counterflex
