#pragma once
/// Arrays of numbers in the data of a page.
#include <bit>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "counterflex/files/files.hpp"
#include "counterflex/files/text.hpp"

namespace counterflex {

static_assert(std::endian::native == std::endian::little, "arrays are written as they are in memory");

/// The bytes of the numbers in base64. What is left of zero by rounding differs between computers: nine
/// decimals are kept. What is unknown stays NaN.
template <typename T>
std::string encoded(std::vector<T> values) {
  if constexpr (std::is_floating_point_v<T>)
    for (T& value : values)
      if (std::isfinite(value)) value = static_cast<T>(rounded(value, 9));
  return base64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

}  // namespace counterflex
