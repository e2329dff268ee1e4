// clang-format off
#include <windows.h>  // comes first
#include <bcrypt.h>
// clang-format on

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "counterflex/files/files.hpp"

namespace counterflex {
namespace {

/// Throws if `status` is a failure.
void check(NTSTATUS status) {
  if (status < 0) throw std::runtime_error("SHA-256 is not available");
}

/// Stays open until the process ends.
BCRYPT_ALG_HANDLE provider() {
  static const BCRYPT_ALG_HANDLE opened = [] {
    BCRYPT_ALG_HANDLE handle = nullptr;
    check(::BCryptOpenAlgorithmProvider(&handle, BCRYPT_SHA256_ALGORITHM, nullptr, 0));
    return handle;
  }();
  return opened;
}

}  // namespace

struct Sha256::State {
  BCRYPT_HASH_HANDLE hash = nullptr;

  State() { check(::BCryptCreateHash(provider(), &hash, nullptr, 0, nullptr, 0, 0)); }
  ~State() { ::BCryptDestroyHash(hash); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

Sha256::Sha256() : state_(new State) {}
Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;

void Sha256::add(std::string_view bytes) {
  constexpr std::size_t at_once = std::size_t{1} << 30;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), at_once)))
    check(::BCryptHashData(state_->hash, reinterpret_cast<UCHAR*>(const_cast<char*>(bytes.data())),
                           static_cast<ULONG>(std::min(bytes.size(), at_once)), 0));
}

std::string Sha256::digits() {
  std::array<UCHAR, 32> digest{};
  check(::BCryptFinishHash(state_->hash, digest.data(), digest.size(), 0));
  std::string text;
  for (const UCHAR byte : digest) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace counterflex
