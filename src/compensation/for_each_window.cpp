#include "counterflex/compensation/for_each_window.hpp"

#include <algorithm>
#include <vector>

#include "pipeline.hpp"

namespace counterflex {

void for_each_window(ProgramReader& reader, int threads, const std::function<void(const Program&)>& first,
                     const std::function<void(const Program&)>& behind) {
  constexpr int useful_threads = 2;
  std::vector<Program> windows(static_cast<std::size_t>(std::clamp(threads, 1, useful_threads)));
  const auto read = [&](std::size_t slot) {
    if (!reader.next()) return false;
    first(reader.window());
    reader.take_window(windows[slot]);
    return true;
  };
  const auto look = [&](std::size_t slot) {
    behind(windows[slot]);
    return true;
  };
  run_pipeline(read, {}, look, windows.size(), threads);
}

}  // namespace counterflex
