#include <doctest/doctest.h>

#include <algorithm>

#include "counterflex/forces/cutting_model.hpp"
#include "forces/sample_cut.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string beginning = R"(format = "counterflex-forces 1"
[cutters.T3]
diameter_mm = 10
flutes = 4
helix_deg = 30
[materials.alu]
Ktc_N_mm2 = 700
Krc_N_mm2 = 210
Kac_N_mm2 = 140
Kte_N_mm = 20
Kre_N_mm = 15
Kae_N_mm = -1.5
[[section]]
cutter = "T3"
material = "alu"
axial_depth_mm = 2
)";

CutSection section(const std::string& rest) {
  const auto sections = read_cutting_model(beginning + rest, "cuts.toml");
  REQUIRE(sections.size() == 1);
  return sections[0];
}

CuttingModel model(const std::string& rest) {
  return section(rest).model;
}

}  // namespace

TEST_CASE("a section's cutter, material and depth are read into SI") {
  const CuttingModel cut = model("side = \"slot\"\nspindle_rpm = 8000\n");
  CHECK(cut.mill.diameter == doctest::Approx(0.01));
  CHECK(cut.mill.flutes == 4);
  CHECK(cut.mill.helix == doctest::Approx(pi / 6));
  CHECK(cut.coefficients.K_tc == doctest::Approx(700e6));
  CHECK(cut.coefficients.K_rc == doctest::Approx(210e6));
  CHECK(cut.coefficients.K_ac == doctest::Approx(140e6));
  CHECK(cut.coefficients.K_te == doctest::Approx(20e3));
  CHECK(cut.coefficients.K_re == doctest::Approx(15e3));
  CHECK(cut.coefficients.K_ae == doctest::Approx(-1.5e3));
  CHECK(cut.axial_depth == doctest::Approx(0.002));
  CHECK(cut.spindle_rpm == 8000);
  CHECK(cut.force_at == ForceAt::mean);
}

TEST_CASE("up milling begins at the entry, down milling ends at the exit, a slot does both") {
  const CuttingModel up = model("side = \"up\"\nradial_depth_mm = 2.5\n");
  CHECK(up.entry == 0);
  CHECK(up.exit == doctest::Approx(pi / 3));
  CHECK(up.wall == Wall::entry);
  const CuttingModel down = model("side = \"down\"\nradial_depth_mm = 2.5\n");
  CHECK(down.entry == doctest::Approx(2 * pi / 3));
  CHECK(down.exit == doctest::Approx(pi));
  CHECK(down.wall == Wall::exit);
  for (const char* width : {"", "radial_depth_mm = 10\n"}) {
    const CuttingModel slot = model(std::string("side = \"slot\"\n") + width);
    CHECK(slot.entry == 0);
    CHECK(slot.exit == doctest::Approx(pi));
    CHECK(slot.wall == Wall::both);
  }
}

TEST_CASE("a radial depth of the whole diameter is cut from side to side, with the wall of its side") {
  CHECK(model("side = \"up\"\nradial_depth_mm = 10\n").exit == doctest::Approx(pi));
  CHECK(model("side = \"down\"\nradial_depth_mm = 10\n").entry == doctest::Approx(0));
  CHECK(model("side = \"up\"\nradial_depth_mm = 10\n").wall == Wall::entry);
}

TEST_CASE("angles have a wall where they begin at 0 or end at 180") {
  CHECK(model("entry_deg = 0\nexit_deg = 60\n").wall == Wall::entry);
  CHECK(model("entry_deg = 100\nexit_deg = 180\n").wall == Wall::exit);
  CHECK(model("entry_deg = 0\nexit_deg = 180\n").wall == Wall::both);
  const CuttingModel inside = model("entry_deg = 30\nexit_deg = 150\n");
  CHECK(inside.wall == Wall::none);
  CHECK(inside.entry == doctest::Approx(pi / 6));
  CHECK(inside.exit == doctest::Approx(5 * pi / 6));
}

TEST_CASE("a section selects the moves that it covers") {
  const CutSection all = section("side = \"slot\"\n");
  CHECK(all.name == "section 1");
  CHECK(all.where.line == 13);
  CHECK(!all.selector.tool);
  CHECK(!all.selector.operation);
  CHECK(!all.selector.lines);
  CHECK(!all.selector.blocks);
  const CutSection some = section(
      "side = \"slot\"\nname = \"floor\"\ntool = \"t12\"\nop = \"POCKET*\"\nlines = [10, 200]\nblocks = [0, "
      "90]\n");
  CHECK(some.name == "floor");
  CHECK(some.selector.tool == 12);
  CHECK(some.selector.operation == "POCKET*");
  CHECK(some.selector.lines == std::array<long, 2>{10, 200});
  CHECK(some.selector.blocks == std::array<long, 2>{0, 90});
  CHECK(section("side = \"slot\"\ntool = 7\n").selector.tool == 7);
}

TEST_CASE("a section's force_at overrides the file's") {
  const std::string file = "force_at = \"surface\"\n";
  const std::string text = beginning + "side = \"slot\"\n";
  const std::size_t second_line = text.find('\n') + 1;
  const auto with_default = [&](const std::string& rest) {
    return read_cutting_model(text.substr(0, second_line) + file + text.substr(second_line) + rest,
                              "cuts.toml")[0]
        .model.force_at;
  };
  CHECK(with_default("") == ForceAt::surface);
  CHECK(with_default("force_at = \"mean\"\n") == ForceAt::mean);
}

TEST_CASE("sections keep the order of the file") {
  const auto sections = read_cutting_model(
      beginning +
          "side = \"slot\"\n[[section]]\ncutter = \"T3\"\nmaterial = \"alu\"\naxial_depth_mm = 3\nside = "
          "\"slot\"\n",
      "cuts.toml");
  REQUIRE(sections.size() == 2);
  CHECK(sections[1].name == "section 2");
  CHECK(sections[1].model.axial_depth == doctest::Approx(0.003));
}

TEST_CASE("every published material can be named, and has its source") {
  CHECK(published_coefficients().size() >= 6);
  for (const PublishedCoefficients& published : published_coefficients()) {
    CAPTURE(published.name);
    std::string text = beginning + "side = \"slot\"\n";
    text.replace(text.find("material = \"alu\""), 16, "material = \"" + published.name + "\"");
    const CuttingModel cut = read_cutting_model(text, "cuts.toml")[0].model;
    CHECK(cut.coefficients.K_tc == published.coefficients.K_tc);
    CHECK(cut.coefficients.K_tc > 100e6);
    CHECK(cut.coefficients.K_tc < 10e9);
    CHECK(cut.coefficients.K_te < 100e3);
    CHECK(published.source.find_first_of("0123456789") != std::string::npos);
    CHECK(!published.material.empty());
    CHECK(!published.cutter.empty());
  }
}

TEST_CASE("a file's own material overrides the published one of its name") {
  std::string text = beginning + "side = \"slot\"\n";
  const std::string published = published_coefficients()[0].name;
  text.replace(text.find("materials.alu"), 13, "materials." + published);
  text.replace(text.find("material = \"alu\""), 16, "material = \"" + published + "\"");
  CHECK(read_cutting_model(text, "cuts.toml")[0].model.coefficients.K_tc == doctest::Approx(700e6));
}
