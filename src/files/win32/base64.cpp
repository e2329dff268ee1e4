
// clang-format off
#include <windows.h>  // comes first
#include <wincrypt.h>
// clang-format on

#include <stdexcept>

#include "counterflex/files/files.hpp"

namespace counterflex {

std::string base64(std::string_view bytes) {
  auto size = static_cast<DWORD>((bytes.size() + 2) / 3 * 4 + 1);  // the system ends it with a zero
  std::string text(size, '\0');
  if (!bytes.empty() &&
      ::CryptBinaryToStringA(reinterpret_cast<const BYTE*>(bytes.data()), static_cast<DWORD>(bytes.size()),
                             CRYPT_STRING_BASE64 | CRYPT_STRING_NOCRLF, text.data(), &size) == 0)
    throw std::runtime_error("base64 is not available");
  text.resize(bytes.empty() ? 0 : size);
  return text;
}

}  // namespace counterflex
