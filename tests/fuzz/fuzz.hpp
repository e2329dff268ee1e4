#pragma once
/// Shared by all fuzz targets.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "counterflex/files/input_error.hpp"

namespace counterflex::fuzz {

/// Stops the fuzzer, which keeps the input.
inline void demand(bool kept) {
  if (!kept) std::abort();
}

/// Calls `read`. The only exception that it may throw is an `InputError` with a line and a column.
template <typename Read>
void accept_or_refuse(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    demand(error.where().line > 0 && error.where().column > 0);
  }
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace counterflex::fuzz
