#include <algorithm>
#include <string>
#include <utility>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/report/report.hpp"

namespace counterflex {
namespace {

constexpr std::size_t longest_text = 200, read_at_once = 1 << 16;  // bytes

/// Reads the lines of a file in order.
class Lines {
 public:
  explicit Lines(FileReader& file) : file_(file) { file_.rewind(); }

  /// The next line without its end; empty after the last one. Valid until the next call.
  std::string_view next() {
    std::size_t end = text_.find('\n', from_);
    while (end == std::string::npos) {
      text_.erase(0, std::exchange(from_, 0));
      if (file_.append(text_, read_at_once) == 0) break;
      end = text_.find('\n');
    }
    std::string_view line = std::string_view(text_).substr(from_, end - from_);
    from_ = end == std::string::npos ? text_.size() : end + 1;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

 private:
  FileReader& file_;
  std::string text_;
  std::size_t from_ = 0;
};

}  // namespace

void add_texts(RunReport& report, FileReader& program) {
  int last = 0;
  for (const WorstRow& row : report.worst) last = std::max(last, row.line);
  Lines lines(program);
  for (int line = 1; line <= last; ++line) {
    const std::string_view text = lines.next();
    for (WorstRow& row : report.worst)
      if (row.line == line) row.text = text.substr(0, longest_text);
  }
}

}  // namespace counterflex
