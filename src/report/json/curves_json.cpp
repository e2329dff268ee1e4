#include <algorithm>
#include <cmath>

#include "counterflex/report/page.hpp"
#include "report/json/encoded.hpp"
#include "report/json/json_numbers.hpp"

namespace counterflex {
namespace {

/// One value for each stretch.
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
  return encoded(std::move(values));
}

/// Whether all values are equal; two unknown values count as equal.
bool same(const std::vector<float>& a, const std::vector<float>& b) {
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

/// Writes a JSON object member by member, without a second copy of its megabytes.
class Members {
 public:
  explicit Members(std::string& text) : text_(text) { text_ += '{'; }
  void add(std::string_view name, std::string_view value) {
    text_.append(separator_).append("\"").append(name).append("\":").append(value);
    separator_ = ",";
  }
  void add_array(std::string_view name, std::string_view encoded) {
    add(name, "\"");
    text_.append(encoded).append("\"");
  }
  void end() { text_ += '}'; }

 private:
  std::string& text_;
  const char* separator_ = "";
};

void add_quantity(std::size_t i, const PathCurves& curves, Members& quantities, std::string& text) {
  const auto largest = column(curves, [i](const Stretch& s) { return s.largest[i]; });
  if (std::all_of(largest.begin(), largest.end(), [](float value) { return std::isnan(value); })) return;
  const auto least = column(curves, [i](const Stretch& s) { return s.least[i]; });
  quantities.add(name_of(static_cast<Quantity>(i)), "");
  Members quantity(text);
  if (!same(least, largest)) quantity.add_array("least", encoded(least));
  quantity.add_array("largest", encoded(largest));
  quantity.end();
}

std::string marks_json(const PathMarks& marks) {
  Json places = Json::array();
  for (const double s : marks.s_mm) places.push_back(number(s, 6));
  return Json{{"count", marks.count}, {"s_mm", std::move(places)}}.dump();
}

template <typename T, typename Value>
std::string encoded_column(const PathCurves& curves, const Value& value) {
  return encoded(column(curves, [&](const Stretch& s) { return static_cast<T>(value(s)); }));
}

void add_places(const PathCurves& curves, Members& members) {
  members.add_array("s_mm", encoded_column<double>(curves, [](const Stretch& s) { return s.s_mm; }));
  const auto add = [&](const char* name, auto Stretch::*member) {
    members.add_array(name,
                      encoded_column<std::int32_t>(curves, [&](const Stretch& s) { return s.*member; }));
  };
  add("first_line", &Stretch::first_line);
  add("last_line", &Stretch::last_line);
  add("operation", &Stretch::operation);
  members.add_array("after_rapid", encoded_column<std::uint8_t>(
                                       curves, [](const Stretch& s) { return s.begins_after_rapid; }));
  members.add_array("place_mm", vectors(curves, &Stretch::place));
  members.add_array("place_before_mm", vectors(curves, &Stretch::before));
  members.add_array("place_after_mm", vectors(curves, &Stretch::after));
  if (curves.waypoints_per_stretch() == 1)
    members.add_array("direction", vectors(curves, &Stretch::direction));
}

}  // namespace

std::string curves_json(const PathCurves& curves) {
  std::string text;
  Members members(text);
  members.add("waypoints", std::to_string(curves.waypoints()));
  members.add("stretches", std::to_string(curves.stretches().size()));
  members.add("waypoints_per_stretch", std::to_string(curves.waypoints_per_stretch()));
  add_places(curves, members);
  members.add("quantities", "");
  Members quantities(text);
  for (std::size_t i = 0; i < quantity_count; ++i) add_quantity(i, curves, quantities, text);
  quantities.end();
  members.add("rapids", marks_json(curves.rapids()));
  members.add("force_steps", marks_json(curves.force_steps()));
  members.end();
  return text;
}

}  // namespace counterflex
