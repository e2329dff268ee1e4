#pragma once
/// What is kept of a window that was compensated, so that another run need not do it again.
#include <optional>
#include <string>
#include <string_view>

#include "window_state.hpp"

namespace counterflex {

struct WindowRecord {
  std::size_t index = 0;  ///< of the window, from 0
  std::size_t bytes = 0;  ///< of its original text
  std::string start;      ///< `digest_of_start`
  WindowState entry, exit;
  std::string commands;   ///< `digest_of_commands` of the text that was written
  Compensation result{};  ///< without `corrected`, which is read from its text, and without `blocks_of_edit`;
                          ///< no failure
};

std::string to_bytes(const WindowRecord& record);

/// Nothing where `bytes` are not what `to_bytes` writes.
std::optional<WindowRecord> window_record_of(std::string_view bytes);

}  // namespace counterflex
