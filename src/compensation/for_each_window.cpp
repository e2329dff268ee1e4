#include "counterflex/compensation/for_each_window.hpp"

#include <vector>

#include "pipeline.hpp"

namespace counterflex {

void for_each_window(ProgramReader& reader, int threads, const std::function<void(const Program&)>& first,
                     const std::function<void(const Program&)>& behind) {
  // One that is read, one that `behind` looks at, and one between them, so that neither waits for the other.
  std::vector<Program> windows(threads > 1 ? 3 : 1);
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
