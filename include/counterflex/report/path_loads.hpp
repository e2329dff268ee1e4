#pragma once
/// Loads along a path as a report says them: the largest of every chain, and how near they come to the limits
/// of the machine file. In the units of their keys (N, N m, mm, deg).
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "counterflex/compensation/loads_along.hpp"
#include "counterflex/machine/machine.hpp"

namespace counterflex {

/// A load in the unit of its kind's key.
double shown_value(const ChainLoads& loads, LoadKind kind);

/// The largest load of a kind; of equal ones the first.
struct LoadPeak {
  double value = 0;
  int line = 0;  ///< of the original program; 0 where nothing bears such a load
  std::optional<double> limit{};
};

/// How much of a limit is used: above 1 it is exceeded; 0 without a limit.
double share_of_limit(const LoadPeak& peak);

/// By more than rounding.
bool is_exceeded(const LoadPeak& peak);

struct LoadsOfChain {
  std::string name;
  std::array<LoadPeak, load_kind_count> peaks{};

  LoadPeak& operator[](LoadKind kind) { return peaks[static_cast<std::size_t>(kind)]; }
  const LoadPeak& operator[](LoadKind kind) const { return peaks[static_cast<std::size_t>(kind)]; }
};

struct PathLoads {
  LoadsAlong along;
  std::vector<LoadsOfChain> chains;  ///< in the machine's order
};

/// None where no place was solved.
std::optional<PathLoads> path_loads(LoadsAlong along, const Machine& machine);

/// "chain leg: spring force 431.2 N", "its limit of 400 N" where it has one.
std::string load_in_words(const LoadsOfChain& chain, LoadKind kind);
std::string limit_in_words(const LoadsOfChain& chain, LoadKind kind);

/// The loads over the path for a page: an object of lists `s_mm` and `line`, and for each of `chains` its
/// `name` and a list of every kind; "null" where there are none. Seven significant digits.
std::string loads_json(const std::optional<PathLoads>& loads);

}  // namespace counterflex
