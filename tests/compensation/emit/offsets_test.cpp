// Several work offsets in one program: each has its own frame.
#include "compensation/support/gantry.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("two work offsets in one program are corrected in their own frames") {
  const std::string text =
      "G21 G90\nG54 G0 X0. Y0. Z10.\nG2 X20. I10. J0. F500\nG0 Z20.\nG55 G0 X0. Y0. Z10.\nG2 X20. I10. "
      "J0.\nG0 "
      "Z20.\nM30\n";
  Shop shop({.machine = displaced_gantry(), .text = text});
  std::vector<WorkFrame> frames(shop.program.frames.size());
  const Pose turned{from_rpy(Vector3(0, 0, 90) * deg), Vector3(50, 20, 0) * mm};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].name = shop.program.frames[i].work_offset;
    if (frames[i].name == "G55") frames[i].X_MW = turned;
  }
  shop.path = build_toolpath(shop.program, frames);
  shop.forces.emplace(ForceSource{}, shop.program, shop.path,
                      std::vector<Matrix3>{tip(shop.model.mechanism, shop.model.home).R});
  const Compensation result = compensated(shop);
  const std::vector<Move> before = moves_in(text), after = moves_in(result.text);
  std::size_t a = 0;
  for (const Move& move : before) {
    CAPTURE(move.line);
    while (a < after.size() && (after[a].end_mm - move.end_mm).norm() > 1) ++a;
    REQUIRE(a < after.size());
    const bool second = shop.program.frames[move.frame].work_offset == "G55";
    const Vector3 expected = second ? Vector3(turned.R.transpose() * shift_mm) : shift_mm;
    CHECK((after[a].end_mm - move.end_mm - expected).norm() < 1e-6);
    ++a;
  }
}
