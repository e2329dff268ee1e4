#pragma once
/// SHA-256 of bytes that come in portions.
#include <memory>
#include <string>
#include <string_view>

namespace counterflex {

class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;

  void add(std::string_view bytes);

  /// Of all that was added, 64 lower-case hexadecimal digits; nothing can be added any more.
  std::string digits();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace counterflex
