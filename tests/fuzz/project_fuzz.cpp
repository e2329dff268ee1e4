/// Fuzz target for project files: what is read is printed as a project file that reads the same.
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

// Whatever this throws is a defect: what is printed can be read.
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
