#pragma once
/// The arrays in the data of a page.
#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace counterflex::test {

/// The bytes of four characters of base64 at a time.
inline std::string decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); i += 4) {
    unsigned group = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t digit = digits.find(text[i + k]);
      group = group << 6 | static_cast<unsigned>(digit == std::string::npos ? 0 : digit);
    }
    for (int shift = 16; shift >= 0; shift -= 8) bytes += static_cast<char>(group >> shift & 255);
  }
  return bytes.substr(0, bytes.size() - static_cast<std::size_t>(std::count(text.begin(), text.end(), '=')));
}

template <typename T>
std::vector<T> array_of(const nlohmann::json& text) {
  const std::string bytes = decoded(text.get<std::string>());
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

}  // namespace counterflex::test
