/// Fuzz target for imported machines: a text is refused with a place, or becomes a machine file that can be
/// read. The first byte is the source: D and d DH tables, Y a UR calibration, U a URDF, H a HAL file, I an
/// INI file.
#include <string>

#include "counterflex/import/import.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "fuzz.hpp"

namespace {

std::string imported(char source, const std::string& text) {
  using namespace counterflex;
  switch (source) {
    case 'D':
      return import_dh(text, "arm.csv", DhConvention::standard);
    case 'd':
      return import_dh(text, "arm.csv", DhConvention::modified);
    case 'Y':
      return import_ur_calibration(text, "arm.yaml");
    case 'U':
      return import_urdf(text, "arm.urdf", "", "tool0");
    case 'H':
      return import_linuxcnc({{"m.hal", text}});
    default:
      return import_linuxcnc({{"m.ini", text}, {"m.hal", text}});
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  std::string text;
  counterflex::fuzz::accept_or_refuse([&] {
    text = imported(static_cast<char>(data[0]), std::string(counterflex::fuzz::text_of(data + 1, size - 1)));
  });
  if (!text.empty()) counterflex::read_machine(text, "machine.toml");
  return 0;
}
