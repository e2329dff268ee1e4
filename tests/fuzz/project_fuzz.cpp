/// Fuzz target for project files: the settings of a file are printed as a project file with the same
/// settings.
#include <string>

#include "counterflex/settings/project_file.hpp"
#include "fuzz.hpp"

namespace counterflex::fuzz {
namespace {

// Without the lines of the file, which differ.
std::vector<Setting> read_without_origins(std::string_view text) {
  std::vector<Setting> settings = read_project(text, "counterflex.toml");
  for (Setting& setting : settings) setting.origin = Origin::builtin;
  return settings;
}

// Any exception here is a defect: printed settings can be read.
void demand_same(const std::vector<Setting>& settings, const std::string& printed) noexcept {
  const auto again = read_without_origins(printed);
  demand(again.size() == settings.size());
  demand(to_project_text(again) == printed);
}

}  // namespace
}  // namespace counterflex::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterflex;
  fuzz::accept_or_refuse([&] {
    const auto settings = fuzz::read_without_origins(fuzz::text_of(data, size));
    fuzz::demand_same(settings, to_project_text(settings));
  });
  return 0;
}
