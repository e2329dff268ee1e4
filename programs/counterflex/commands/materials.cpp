#include "commands/materials.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "counterflex/files/text.hpp"
#include "counterflex/forces/cutting_model.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex::cli {
namespace {

bool is_kienzle(const PublishedCoefficients& published) {
  return published.coefficients.m_c > 0;
}

std::string coefficients_text() {
  std::string text =
      fmt::format("{:<20} {:>7} {:>7} {:>7} {:>6} {:>6} {:>6}   {}\n{:<20} {:>23} {:>20}\n", "material",
                  "Ktc", "Krc", "Kac", "Kte", "Kre", "Kae", "of", "", "N/mm2", "N/mm");
  for (const PublishedCoefficients& published : published_coefficients()) {
    if (is_kienzle(published)) continue;
    const CuttingCoefficients& K = published.coefficients;
    text +=
        fmt::format("{:<20} {:>7.1f} {:>7.1f} {:>7.1f} {:>6.2f} {:>6.2f} {:>6.2f}   {}, {}\n", published.name,
                    K.K_tc / N_per_mm2, K.K_rc / N_per_mm2, K.K_ac / N_per_mm2, K.K_te / N_per_mm,
                    K.K_re / N_per_mm, K.K_ae / N_per_mm, published.material, published.cutter);
  }
  return text;
}

std::string kienzle_text() {
  std::string text =
      fmt::format("{:<20} {:>7} {:>7}   {}\n{:<20} {:>7}\n", "material", "kc1.1", "mc", "of", "", "N/mm2");
  for (const PublishedCoefficients& published : published_coefficients())
    if (is_kienzle(published))
      text += fmt::format("{:<20} {:>7.0f} {:>7.2f}   {}; {}\n", published.name,
                          main_value(published.coefficients) / N_per_mm2, published.coefficients.m_c,
                          published.material, published.cutter);
  return text;
}

std::string materials_text() {
  std::string text =
      coefficients_text() +
      "\nBy Kienzle, tangential force only: state radial_share and axial_share in the section.\n" +
      kienzle_text();
  text += "\nsources\n";
  for (const PublishedCoefficients& published : published_coefficients())
    text += fmt::format("  {:<20} {}\n", published.name, published.source);
  return text +
         "\nEdges, coatings and wear change them by tens of percent: measure your own where it matters.\n";
}

std::string materials_json() {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const PublishedCoefficients& published : published_coefficients()) {
    const CuttingCoefficients& K = published.coefficients;
    nlohmann::ordered_json entry{{"name", published.name},
                                 {"material", published.material},
                                 {"cutter", published.cutter},
                                 {"source", published.source}};
    if (is_kienzle(published))
      entry.update({{"kc11_N_mm2", rounded(main_value(K) / N_per_mm2, 6)}, {"mc", K.m_c}});
    else
      entry.update({{"Ktc_N_mm2", rounded(K.K_tc / N_per_mm2, 6)},
                    {"Krc_N_mm2", rounded(K.K_rc / N_per_mm2, 6)},
                    {"Kac_N_mm2", rounded(K.K_ac / N_per_mm2, 6)},
                    {"Kte_N_mm", rounded(K.K_te / N_per_mm, 6)},
                    {"Kre_N_mm", rounded(K.K_re / N_per_mm, 6)},
                    {"Kae_N_mm", rounded(K.K_ae / N_per_mm, 6)}});
    list.push_back(std::move(entry));
  }
  return nlohmann::ordered_json{{"schema", "counterflex-materials 1"}, {"materials", list}}.dump(2) + "\n";
}

}  // namespace

std::string materials_page(bool json) {
  return json ? materials_json() : materials_text();
}

}  // namespace counterflex::cli
