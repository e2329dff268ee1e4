#include <algorithm>
#include <bit>
#include <cmath>

#include "counterflex/files/files.hpp"
#include "counterflex/report/page.hpp"
#include "json_numbers.hpp"

namespace counterflex {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they are in memory");

template <typename T>
std::string encoded(const std::vector<T>& values) {
  return base64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

/// One value of each stretch.
template <typename Value>
auto column(const PathCurves& curves, const Value& value) {
  std::vector<decltype(value(curves.stretches().front()))> values;
  values.reserve(curves.stretches().size());
  for (const Stretch& stretch : curves.stretches()) values.push_back(value(stretch));
  return values;
}

std::string vectors(const PathCurves& curves, std::array<float, 3> Stretch::*vector) {
  std::vector<float> values;
  for (const Stretch& stretch : curves.stretches())
    values.insert(values.end(), (stretch.*vector).begin(), (stretch.*vector).end());
  return encoded(values);
}

/// Neither differs from the other but where both are unknown.
bool same(const std::vector<float>& a, const std::vector<float>& b) {
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

Json quantities_json(const PathCurves& curves) {
  Json quantities = Json::object();
  for (std::size_t i = 0; i < quantity_count; ++i) {
    const auto largest = column(curves, [i](const Stretch& s) { return s.largest[i]; });
    if (std::all_of(largest.begin(), largest.end(), [](float value) { return std::isnan(value); })) continue;
    const auto least = column(curves, [i](const Stretch& s) { return s.least[i]; });
    Json& quantity = quantities[std::string(name_of(static_cast<Quantity>(i)))];
    if (!same(least, largest)) quantity["least"] = encoded(least);
    quantity["largest"] = encoded(largest);
  }
  return quantities;
}

Json marks_json(const PathMarks& marks) {
  Json places = Json::array();
  for (const double s : marks.s_mm) places.push_back(number(s, 6));
  return {{"count", marks.count}, {"s_mm", std::move(places)}};
}

}  // namespace

std::string curves_json(const PathCurves& curves) {
  const Json document = {
      {"waypoints", curves.waypoints()},
      {"stretches", curves.stretches().size()},
      {"waypoints_per_stretch", curves.waypoints_per_stretch()},
      {"s_mm", encoded(column(curves, [](const Stretch& s) { return s.s_mm; }))},
      {"first_line", encoded(column(curves, [](const Stretch& s) { return std::int32_t{s.first_line}; }))},
      {"last_line", encoded(column(curves, [](const Stretch& s) { return std::int32_t{s.last_line}; }))},
      {"operation", encoded(column(curves, [](const Stretch& s) { return s.operation; }))},
      {"after_rapid",
       encoded(
           column(curves, [](const Stretch& s) { return static_cast<std::uint8_t>(s.begins_after_rapid); }))},
      {"place_mm", vectors(curves, &Stretch::place)},
      {"place_before_mm", vectors(curves, &Stretch::before)},
      {"place_after_mm", vectors(curves, &Stretch::after)},
      {"quantities", quantities_json(curves)},
      {"rapids", marks_json(curves.rapids())},
      {"force_steps", marks_json(curves.force_steps())}};
  return document.dump();
}

}  // namespace counterflex
