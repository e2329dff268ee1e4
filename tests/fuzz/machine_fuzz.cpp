/// Fuzz target for machine files: a text is refused with a place, or becomes a model.
#include <string>

#include "counterflex/machine/read_machine.hpp"
#include "counterflex/statics/nominal.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterflex;
  fuzz::accept_or_refuse([&] {
    const Machine machine = read_machine(fuzz::text_of(data, size), "machine.toml");
    fuzz::demand(!describe(machine).empty());
    structural_notes(machine);
    prepare(machine);
  });
  return 0;
}
