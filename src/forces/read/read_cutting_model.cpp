#include <fmt/format.h>

#include "counterflex/forces/cutting_model.hpp"
#include "forces/read/read_cut_section.hpp"

namespace counterflex {
namespace {

using toml_file::Source;

constexpr std::string_view format_of_cuts = "counterflex-forces 1";

void check_format_of_cuts(const toml::table& document, const Source& source) {
  const toml::node* node = document.get("format");
  if (node == nullptr)
    source.fail_at_start(
        fmt::format("no format; a file of cutting models begins with format = \"{}\"", format_of_cuts));
  const auto* text = node->as_string();
  if (text == nullptr || text->get() != format_of_cuts)
    source.fail(*node,
                fmt::format("format is {}; it must be \"{}\"", toml_file::seen(*node), format_of_cuts));
}

const toml::array& sections_of(const toml::table& document, const Source& source) {
  const toml::node* node = document.get("section");
  if (node == nullptr)
    source.fail_at_start("no [[section]]; a file of cutting models must have at least one");
  if (!node->is_array_of_tables())
    source.fail(
        *node, fmt::format("section must be tables, each under [[section]], not {}", toml_file::seen(*node)));
  return *node->as_array();
}

}  // namespace

std::vector<CutSection> read_cutting_model(std::string_view text, const std::string& file) {
  const Source source(text, file);
  const toml::table document = source.parse();
  check_format_of_cuts(document, source);
  toml_file::check_keys(document, {"format", "force_at", "cutters", "materials", "section"},
                        "a file of cutting models", source);
  force_file::CutLibrary library{
      force_file::read_cutters(document, source), force_file::read_materials(document, source), {}};
  if (const toml::node* force_at = document.get("force_at"))
    library.force_at = force_file::read_force_at(*force_at, source);
  std::vector<CutSection> sections;
  for (const toml::node& node : sections_of(document, source))
    sections.push_back(force_file::read_cut_section(node, sections.size() + 1, library, source));
  return sections;
}

}  // namespace counterflex
