#include <charconv>

#include "counterflex/files/files.hpp"

namespace counterflex {

std::string sha256(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.digits();
}

std::string integrity(std::string_view bytes) {
  const std::string digits = sha256(bytes);
  std::string digest;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    unsigned value = 0;
    std::from_chars(digits.data() + i, digits.data() + i + 2, value, 16);
    digest += static_cast<char>(value);
  }
  return "sha256-" + base64(digest);
}

}  // namespace counterflex
