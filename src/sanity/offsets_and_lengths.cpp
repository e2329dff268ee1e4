#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "counterflex/sanity/checks.hpp"

namespace counterflex {
namespace {

constexpr std::size_t most_named = 6;

std::string named(const std::vector<std::string>& all) {
  const std::vector<std::string> first(
      all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), most_named)));
  return fmt::format("{}{}", fmt::join(first, ", "),
                     all.size() > most_named ? fmt::format(" and {} more", all.size() - most_named) : "");
}

}  // namespace

SanityCheck check_tool_lengths(const std::map<long, double>& lengths_mm, const std::vector<long>& used,
                               bool has_spindle) {
  std::vector<std::string> known, unknown;
  for (const auto& [number, length] : lengths_mm)
    if (used.empty() || std::find(used.begin(), used.end(), number) != used.end())
      known.push_back(fmt::format("T{} = {:.6g} mm", number, length));
  for (const long number : used)
    if (number != 0 && lengths_mm.count(number) == 0) unknown.push_back(fmt::format("T{}", number));
  if (!has_spindle && !known.empty())
    return {"tool lengths", SanityState::doubtful,
            fmt::format(
                "{} {} known, but without [spindle] in the machine file every tool has the tip of [tool]: "
                "give [spindle], or put the length into [tool]",
                named(known), known.size() == 1 ? "is" : "are")};
  if (!has_spindle)
    return {"tool lengths", SanityState::ok, "no length is given: every tool has the tip of [tool]"};
  if (!unknown.empty())
    return {"tool lengths", SanityState::doubtful,
            fmt::format("the length of {} is unknown: the tip of [tool] is used; give --tool-length {}=MM, "
                        "--tool-table, or [tools.{}] length_mm",
                        named(unknown), unknown.front(), unknown.front())};
  if (known.empty())
    return {"tool lengths", SanityState::ok, "the program selects no tool by its number: [tool] is used"};
  return {"tool lengths", SanityState::ok, fmt::format("{}, from [spindle] to the tip", named(known))};
}

SanityCheck check_work_offset(const std::vector<std::string>& selected, bool known) {
  std::vector<std::string> names;
  for (const std::string& name : selected)  // of frames: shifts of one offset are several
    if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(name);
  if (known) {
    if (selected.empty()) return {"work offset", SanityState::ok, "the program gives its base"};
    if (names.empty()) return {"work offset", SanityState::ok, "G54, with which controls start"};
    return {"work offset", SanityState::ok, named(names)};
  }
  if (selected.empty()) return {"work offset", SanityState::ok, "the program gives its base"};
  if (names.empty())
    return {"work offset", SanityState::ok,
            "the program does not select one: its coordinates are machine coordinates"};
  return {
      "work offset", SanityState::doubtful,
      fmt::format("the program selects {}, but no work offset is given: its coordinates are taken as machine "
                  "coordinates; give --work '{}=X,Y,Z' or [work.\"{}\"] in the machine file, or confirm with "
                  "--work machine",
                  named(names), names.front(), names.front())};
}

}  // namespace counterflex
