#include <openssl/evp.h>

#include <charconv>

#include "counterflex/files/files.hpp"

namespace counterflex {

std::string base64(std::string_view bytes) {
  std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');  // the library ends it with a zero
  const int size =
      EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                      reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(size));
  return text;
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
