#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/files/text.hpp"
#include "counterflex/forces/spindle_fit.hpp"
#include "counterflex/geometry/types.hpp"
#include "toml/source.hpp"

namespace counterflex {
namespace {

/// A basic string of TOML.
std::string quoted_name(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string name_of(const FittedMaterial& fitted) {
  const std::string end = " of " + fitted.cutter;
  return fitted.material.ends_with(end) ? fitted.material : fitted.material + end;
}

std::string table_of(const FittedMaterial& fitted) {
  const CuttingCoefficients& K = fitted.coefficients;
  std::string text = fmt::format("\n# {}\n[materials.{}]\n", fitted.comment, quoted_name(name_of(fitted)));
  const auto line = [&](std::string_view key, double value) {
    text += fmt::format("{} = {:.7g}\n", key, value);
  };
  if (K.m_c > 0) {
    line("kc11_N_mm2", main_value(K) / N_per_mm2);
    line("mc", K.m_c);
    line("radial_share", K.K_rc / K.K_tc);
    line("axial_share", K.K_ac / K.K_tc);
    return text;
  }
  line("Ktc_N_mm2", K.K_tc / N_per_mm2);
  line("Krc_N_mm2", K.K_rc / N_per_mm2);
  line("Kac_N_mm2", K.K_ac / N_per_mm2);
  line("Kte_N_mm", K.K_te / N_per_mm);
  line("Kre_N_mm", K.K_re / N_per_mm);
  line("Kae_N_mm", K.K_ae / N_per_mm);
  return text;
}

/// The place of a location in the text.
std::size_t offset_of(std::string_view text, const Location& where) {
  std::size_t at = 0;
  for (int line = 1; line < where.line; ++line) at = text.find('\n', at) + 1;
  return at + static_cast<std::size_t>(where.column - 1);
}

/// Removes a table of a material that is written again, from the comment before it to the next table.
void remove_table(std::string& text, const std::string& file, const std::string& name) {
  const toml_file::Source source(text, file);
  const toml::table document = source.parse();
  const toml::node* node = document.at_path("materials").node();
  const toml::table* materials = node == nullptr ? nullptr : node->as_table();
  if (materials == nullptr || !materials->contains(name)) return;
  const std::string header = fmt::format("[materials.{}]", quoted_name(name));
  const std::size_t at = text.find(header);
  if (at == std::string::npos || (at > 0 && text[at - 1] != '\n'))
    source.fail(*materials->get(name),
                fmt::format("the table of \"{}\" cannot be replaced; write it as {}", name, header));
  std::size_t begin = at;
  const std::size_t line_before = at < 2 ? std::string::npos : text.rfind('\n', at - 2);
  const std::size_t comment = line_before == std::string::npos ? 0 : line_before + 1;
  if (text[comment] == '#') begin = comment;
  std::size_t end = text.find("\n[", at);
  end = end == std::string::npos ? text.size() : end + 1;
  text.erase(begin, end - begin);
}

}  // namespace

std::string with_fitted_materials(std::string_view text, const std::string& file,
                                  const std::vector<FittedMaterial>& fitted) {
  std::string out(text);
  for (const FittedMaterial& material : fitted) remove_table(out, file, name_of(material));
  const toml_file::Source source(out, file);
  const toml::table document = source.parse();
  struct Edit {
    std::size_t at, length;
    std::string name;
  };
  std::vector<Edit> edits;
  for (const toml::node& section : *document.get("section")->as_array()) {
    const toml::table& table = *section.as_table();
    for (const FittedMaterial& material : fitted) {
      if (table.get("cutter")->value_or(std::string()) != material.cutter) continue;
      if (table.get("material")->value_or(std::string()) != material.material) continue;
      const toml::source_region& region = table.get("material")->source();
      const std::size_t begin = offset_of(out, source.at(region)),
                        end = offset_of(out, source.at({region.end, region.end, region.path}));
      edits.push_back({begin, end - begin, quoted_name(name_of(material))});
    }
  }
  std::sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.at > b.at; });
  for (const Edit& edit : edits) out.replace(edit.at, edit.length, edit.name);
  while (out.ends_with("\n\n")) out.pop_back();
  if (!out.ends_with('\n')) out += '\n';
  for (const FittedMaterial& material : fitted) out += table_of(material);
  read_cutting_model(out, fmt::format("{} with its fitted materials", file));
  return out;
}

}  // namespace counterflex
