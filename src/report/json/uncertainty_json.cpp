#include "report/json/uncertainty_json.hpp"

#include "report/json/summary_json.hpp"

namespace counterflex {
namespace {

constexpr int band_digits = 7;  // 1e-7 mm

Json sampled_json(const std::optional<SampledBands>& bands) {
  if (!bands) return nullptr;
  return {{"samples", bands->samples},
          {"places", bands->places},
          {"unsolved", bands->unsolved},
          {"covered_percent", number(bands->covered_percent, 4)},
          {"least_ratio", number(bands->least_ratio, 4)},
          {"largest_ratio", number(bands->largest_ratio, 4)}};
}

}  // namespace

Json bands_json(const BandStatistics& bands) {
  return {{"k", 2},
          {"at_max_mm", number(bands.at_max_mm, band_digits)},
          {"largest_mm", number(bands.largest_mm, band_digits)},
          {"largest_line", bands.largest_line},
          {"rms_mm", optional_number(bands.rms_mm)},
          {"below_percent", optional_number(bands.below_percent)}};
}

Json as_programmed_json(const AsProgrammed& found) {
  const auto known = [](bool is_known, double value) {
    return is_known ? number(value, band_digits) : Json(nullptr);
  };
  const bool is_any_left = found.largest_line > 0;
  return {{"targets", found.targets},
          {"as_programmed", found.left},
          {"length_percent", known(found.length_mm > 0, 100 * found.left_mm / found.length_mm)},
          {"largest_mm", known(is_any_left, found.largest_mm)},
          {"band_mm", known(is_any_left, found.band_mm)},
          {"line", found.largest_line}};
}

Json uncertainty_json(const UncertaintyReport& of) {
  Json json = {{"k", 2},
               {"parameters", of.parameters},
               {"known_parameters", of.known_parameters},
               {"force_percent", number(100 * of.stated.force, band_digits)},
               {"tool_length_um", number(of.stated.tool_length / um, band_digits)},
               {"repeatability_um", number(of.stated.repeatability / um, band_digits)},
               {"temperature_K", number(of.stated.temperature, band_digits)},
               {"at_worst", nullptr},
               {"sampled", sampled_json(of.sampled)}};
  if (const auto& at = of.at_worst)
    json["at_worst"] = {{"band_mm", number(at->all_mm, band_digits)},
                        {"parameters_mm", number(at->parameters_mm, band_digits)},
                        {"force_mm", number(at->force_mm, band_digits)},
                        {"others_mm", number(at->others_mm, band_digits)}};
  return json;
}

}  // namespace counterflex
