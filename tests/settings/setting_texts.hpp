#pragma once
/// Shared by the tests of settings.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "counterflex/settings/project_file.hpp"
#include "support/text.hpp"

namespace counterflex::test {

inline std::vector<Setting> project_with(const std::string& lines, const std::string& file = "p.toml") {
  return read_project("format = \"counterflex-project 1\"\n" + lines, file);
}

inline const Setting& setting(const std::vector<Setting>& settings, const std::string& option) {
  const auto found = std::find_if(settings.begin(), settings.end(),
                                  [&](const Setting& entry) { return entry.option == option; });
  REQUIRE(found != settings.end());
  return *found;
}

inline std::vector<std::string> values(const std::vector<Setting>& settings, const std::string& option) {
  return setting(settings, option).values;
}

inline std::string value(const std::vector<Setting>& settings, const std::string& option) {
  const auto all = values(settings, option);
  REQUIRE(all.size() == 1);
  return all[0];
}

}  // namespace counterflex::test
