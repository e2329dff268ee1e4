#include <algorithm>

#include "counterflex/settings/project_file.hpp"
#include "settings/keys.hpp"

namespace counterflex {

const Location& place_of(const Setting& setting, std::size_t i) {
  return i < setting.places.size() ? setting.places[i] : setting.where;
}

std::string shown_option(std::string_view option, Origin origin) {
  if (origin == Origin::flag) return "--" + std::string(option);
  return origin == Origin::environment ? setting_file::variable_of(option)
                                       : setting_file::key_of_option(option);
}

}  // namespace counterflex
