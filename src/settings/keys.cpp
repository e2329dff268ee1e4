#include "settings/keys.hpp"

#include <algorithm>

namespace counterflex::setting_file {

std::string key_of_option(std::string_view option) {
  if (option == "tool-length") return "tools";
  std::string key(option);
  std::replace(key.begin(), key.end(), '-', '_');
  return key;
}

std::string variable_of(std::string_view option) {
  std::string name = "COUNTERFLEX_";
  for (const char c : option)
    name += c == '-' ? '_' : c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return name;
}

}  // namespace counterflex::setting_file
