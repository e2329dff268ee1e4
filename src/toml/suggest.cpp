#include "toml/suggest.hpp"

#include <fmt/format.h>

#include "counterflex/files/text.hpp"

namespace counterflex::toml_file {

std::string hint(std::string_view name, const std::vector<std::string_view>& known, std::string_view kind) {
  if (known.empty()) return fmt::format("; {}: nothing", kind);
  const std::string_view meant = nearest(name, known);
  const std::string list = fmt::format("{}: {}", kind, fmt::join(known, ", "));
  return meant.empty() ? "; " + list : fmt::format("; did you mean \"{}\"? {}", meant, list);
}

}  // namespace counterflex::toml_file
