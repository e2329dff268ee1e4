/// Fuzz target for force files. The first byte chooses the kind: a letter in upper case is followed by a
/// profile (CSV), any other byte by cutting models (TOML). The result is applied to a small program.
#include <cctype>

#include "counterflex/forces/forces.hpp"
#include "counterflex/program/read_program.hpp"
#include "fuzz.hpp"

namespace counterflex::fuzz {
namespace {

const Program& small_program() {
  static const Program program = read_program(
      "G21 G90 G54\nT1 M6\n(POCKET)\nS8000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F200\nX20 F900\nG2 X40 I10 J0\nN90 G1 "
      "Y30\nG0 Z5\nM2\n",
      "part.ngc", {});
  return program;
}

void act(ForceSource source) {
  static const Toolpath path = build_toolpath(small_program(), one_frame(small_program(), {}));
  const PathForces forces(source, small_program(), path, {Matrix3::Identity()});
  for (std::size_t s = 0; s < path.segments.size(); ++s)
    if (path.segments[s].cutting) demand(forces.at(s, 0.5, Side::before).allFinite());
}

}  // namespace
}  // namespace counterflex::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterflex;
  if (size == 0) return 0;
  fuzz::accept_or_refuse([&] {
    const std::string_view text = fuzz::text_of(data + 1, size - 1);
    ForceSource source;
    source.rules =
        std::isupper(data[0]) ? read_force_csv(text, "forces.csv") : read_force_toml(text, "forces.toml");
    fuzz::act(std::move(source));
  });
  return 0;
}
