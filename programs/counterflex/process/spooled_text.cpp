#include "process/spooled_text.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "counterflex/files/input_error.hpp"

namespace counterflex::cli {
namespace {

[[noreturn]] void fail(const char* what) {
  throw InputError(ErrorKind::transient_io, {},
                   fmt::format("cannot {} a temporary file: {}", what, std::strerror(errno)));
}

}  // namespace

SpooledText::SpooledText() : file_(std::tmpfile()) {
  if (!file_) fail("make");
}

void SpooledText::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) fail("write");
}

void SpooledText::read(const std::function<void(std::string)>& lines) {
  constexpr std::size_t at_once = 1 << 16;
  if (std::fflush(file_.get()) != 0 || std::fseek(file_.get(), 0, SEEK_SET) != 0) fail("read");
  std::string text;
  for (;;) {
    const std::size_t begin = text.size();
    text.resize(begin + at_once);
    text.resize(begin + std::fread(text.data() + begin, 1, at_once, file_.get()));
    if (std::ferror(file_.get()) != 0) fail("read");
    if (text.size() == begin) break;
    const std::size_t whole = text.rfind('\n') + 1;  // 0 without a newline
    std::string behind = text.substr(whole);
    text.resize(whole);
    lines(std::move(text));
    text = std::move(behind);
  }
  if (!text.empty()) lines(std::move(text));
}

}  // namespace counterflex::cli
