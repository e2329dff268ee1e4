#pragma once
/// Text in a nameless temporary file, which is written once and read as often as wanted.
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace counterflex::cli {

class SpooledText {
 public:
  /// Throws `InputError` (ErrorKind::transient_io), as all members, if the file cannot be written or read.
  SpooledText();

  void write(std::string_view bytes);

  /// Calls `lines` with all of the text, in portions of whole lines.
  void read(const std::function<void(std::string)>& lines);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace counterflex::cli
