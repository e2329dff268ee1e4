#pragma once
/// Values of JSON documents: rounded to hide noise, and null without a number.
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {

using Json = nlohmann::ordered_json;

inline Json number(double value, int decimals) {
  if (!std::isfinite(value)) return nullptr;
  return rounded(value, decimals);
}

/// With that many significant digits.
Json significant(double value, int digits);

template <typename Vector>
Json numbers(const Vector& values, int decimals) {
  Json list = Json::array();
  for (Eigen::Index i = 0; i < values.size(); ++i) list.push_back(number(values[i], decimals));
  return list;
}

/// The document on one line. Bytes that are not UTF-8 become replacement characters. Control characters are
/// escaped, so that a terminal may show the text: strings keep them.
std::string on_one_line(const Json& document);

/// The same, indented by two spaces, lists of plain values on one line, with a newline at the end.
std::string dump(const Json& document);

}  // namespace counterflex
