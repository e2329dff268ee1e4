#include "process/spooled_text.hpp"

#include <algorithm>

namespace counterflex::cli {
namespace {

constexpr std::size_t portion = 1 << 16;  // bytes, of one call of the system

}  // namespace

void SpooledText::write(std::string_view bytes) {
  unwritten_ += bytes;
  if (unwritten_.size() >= portion) flush();
}

void SpooledText::flush() {
  file_.append(unwritten_);
  written_ += unwritten_.size();
  unwritten_.clear();
}

void SpooledText::read(const std::function<void(std::string)>& lines) {
  flush();
  std::string text;
  for (std::size_t at = 0; at < written_;) {
    const std::size_t begin = text.size(), count = std::min(portion, written_ - at);
    text.resize(begin + count);
    file_.read(at, text.data() + begin, count);
    at += count;
    const std::size_t whole = text.rfind('\n') + 1;  // 0 without a newline
    std::string behind = text.substr(whole);
    text.resize(whole);
    lines(std::move(text));
    text = std::move(behind);
  }
  if (!text.empty()) lines(std::move(text));
}

}  // namespace counterflex::cli
