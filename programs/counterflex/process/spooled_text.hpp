#pragma once
/// Text in a nameless temporary file, which is written once and read as often as wanted.
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "counterflex/files/files.hpp"

namespace counterflex::cli {

/// All members throw `InputError` (ErrorKind::transient_io) if the file cannot be written or read.
class SpooledText {
 public:
  void write(std::string_view bytes);

  /// Calls `lines` with all of the text, in portions of whole lines.
  void read(const std::function<void(std::string)>& lines);

 private:
  void flush();

  Spool file_;
  std::string unwritten_;
  std::size_t written_ = 0;
};

}  // namespace counterflex::cli
