/// Fuzz target for tool tables.
#include <cmath>

#include "counterflex/machine/read_machine.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterflex;
  fuzz::accept_or_refuse([&] {
    for (const auto& [tool, length] : read_tool_table(fuzz::text_of(data, size), "tool.tbl"))
      fuzz::demand(tool >= 0 && std::isfinite(length));
  });
  return 0;
}
