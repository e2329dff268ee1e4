#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "counterflex/report/path_curves.hpp"
#include "counterflex/report/report.hpp"

namespace counterflex {

namespace {

// Results on different processors differ by less than this: the first of such loads counts as the largest.
constexpr double indistinct_load = 1e-7;

// In the unit of its key: what is left of zero by the rounding of sums of loads.
constexpr double no_load = 1e-9;

LoadPeak peak_of(const LoadsAlong& along, std::size_t chain, LoadKind kind) {
  LoadPeak peak;
  double named = 0;  // the value in the reported line
  for (const LoadsAtPlace& place : along.places) {
    const double value = shown_value(place.chains[chain], kind);
    if (value > named * (1 + indistinct_load)) {
      named = value;
      peak.line = place.line;
    }
    peak.value = std::max(peak.value, value);
  }
  return peak;
}

LoadsOfChain loads_of_chain(const LoadsAlong& along, std::size_t chain, const Machine& machine) {
  LoadsOfChain loads;
  loads.name = along.places.front().chains[chain].name;
  for (const LoadKind kind : load_kinds) {
    loads[kind] = peak_of(along, chain, kind);
    if (machine.load_limits.empty()) continue;
    if (const auto& most = machine.load_limits[chain][kind]) loads[kind].limit = *most / name_of(kind).si;
  }
  return loads;
}

// With four significant digits, or as many as there are before the point.
std::string four_digits(double value) {
  const double shown = *read_number(fmt::format("{:.3e}", value));  // 99.999 is 100.0, not 100.00
  const int before_point = shown > 0 ? static_cast<int>(std::floor(std::log10(shown))) + 1 : 1;
  return format_fixed(value, std::clamp(4 - before_point, 0, 7));
}

}  // namespace

double shown_value(const ChainLoads& loads, LoadKind kind) {
  const double value = loads[kind] / name_of(kind).si;
  return value < no_load ? 0 : value;
}

double share_of_limit(const LoadPeak& peak) {
  return peak.limit ? peak.value / *peak.limit : 0;
}

bool is_exceeded(const LoadPeak& peak) {
  return share_of_limit(peak) > 1 + 1e-9;
}

std::optional<PathLoads> path_loads(LoadsAlong along, const Machine& machine) {
  if (along.places.empty()) return std::nullopt;
  PathLoads loads{std::move(along), {}};
  for (std::size_t c = 0; c < loads.along.places.front().chains.size(); ++c)
    loads.chains.push_back(loads_of_chain(loads.along, c, machine));
  return loads;
}

std::string load_in_words(const LoadsOfChain& chain, LoadKind kind) {
  const LoadName& name = name_of(kind);
  return fmt::format("chain {}: {} {} {}", chain.name, name.words, four_digits(chain[kind].value), name.unit);
}

std::string limit_in_words(const LoadsOfChain& chain, LoadKind kind) {
  return fmt::format("its limit of {:.9g} {}", *chain[kind].limit, name_of(kind).unit);
}

void add_loads(RunReport& report, LoadsAlong along, const Machine& machine) {
  report.loads = path_loads(std::move(along), machine);
  if (!report.loads) return;
  for (const LoadsOfChain& chain : report.loads->chains)
    for (const LoadKind kind : load_kinds)
      if (is_exceeded(chain[kind]))
        list(report.warnings, Remark{chain[kind].line, load_in_words(chain, kind) + " is above " +
                                                           limit_in_words(chain, kind)});
}

}  // namespace counterflex
