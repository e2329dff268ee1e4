#pragma once
/// Arrays of numbers in the data of a page.
#include <bit>
#include <string>
#include <vector>

#include "counterflex/files/files.hpp"

namespace counterflex {

static_assert(std::endian::native == std::endian::little, "arrays are written as they are in memory");

/// The bytes of the numbers in base64.
template <typename T>
std::string encoded(const std::vector<T>& values) {
  return base64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

}  // namespace counterflex
