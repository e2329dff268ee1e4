#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

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
  CHECK(published_coefficients().size() >= 18);
  for (const PublishedCoefficients& published : published_coefficients()) {
    CAPTURE(published.name);
    std::string text = beginning + "side = \"slot\"\n";
    if (published.coefficients.m_c > 0) text += "radial_share = 0.3\naxial_share = 0.1\n";
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

namespace {

/// The section with Kienzle's keys in the material, and `rest` in the section.
CuttingModel kienzle(const std::string& of_material, const std::string& rest) {
  const std::string alu = beginning.substr(beginning.find("Ktc_N_mm2"),
                                           beginning.find("[[section]]") - beginning.find("Ktc_N_mm2"));
  std::string text = beginning + rest;
  text.replace(text.find(alu), alu.size(), of_material);
  return read_cutting_model(text, "cuts.toml")[0].model;
}

}  // namespace

TEST_CASE("Kienzle's kc1.1 in N/mm2 at 1 mm is read into SI, with shares of the material or of the section") {
  const std::string main = "kc11_N_mm2 = 1500\nmc = 0.22\n", slot = "side = \"slot\"\n";
  const CuttingModel of_material = kienzle(main + "radial_share = 0.3\naxial_share = -0.1\n", slot);
  const CuttingCoefficients& K = of_material.coefficients;
  CHECK(K.m_c == 0.22);
  CHECK(main_value(K) == doctest::Approx(1500e6));
  // At h = 0.1 mm: 1500 0.1^-0.22 N/mm2.
  CHECK(K.K_tc * std::pow(1e-4, -0.22) == doctest::Approx(1500e6 * std::pow(0.1, -0.22)));
  CHECK(K.K_rc == doctest::Approx(0.3 * K.K_tc));
  CHECK(K.K_ac == doctest::Approx(-0.1 * K.K_tc));
  const CuttingModel of_section =
      kienzle(main + "radial_share = 0.3\naxial_share = 0.1\n", slot + "radial_share = 0.5\n");
  CHECK(of_section.coefficients.K_rc == doctest::Approx(0.5 * K.K_tc));
  CHECK(of_section.coefficients.K_ac == doctest::Approx(0.1 * K.K_tc));
}

TEST_CASE("without an exponent Kienzle's law is the linear one") {
  const CuttingModel cut =
      kienzle("kc11_N_mm2 = 700\nmc = 0\nradial_share = 0.3\naxial_share = 0.2\n", "side = \"slot\"\n");
  CHECK(cut.coefficients.K_tc == doctest::Approx(700e6));
  CHECK(cut.coefficients.K_rc == doctest::Approx(210e6));
  CHECK(cut.coefficients.K_ac == doctest::Approx(140e6));
}

TEST_CASE("a cutter has a corner radius, a section of it a radial depth at every height") {
  std::string text = beginning + "side = \"up\"\nradial_depth_mm = 2\n";
  text.insert(text.find("helix_deg"), "corner_radius_mm = 5\n");
  const CuttingModel cut = read_cutting_model(text, "cuts.toml")[0].model;
  CHECK(cut.mill.corner_radius == doctest::Approx(5e-3));
  CHECK(cut.radial_depth == doctest::Approx(2e-3));
  CHECK(model("side = \"up\"\nradial_depth_mm = 2\n").radial_depth == 0);
}

TEST_CASE("a section of a drill has neither a depth nor an engagement") {
  std::string text = beginning.substr(0, beginning.find("axial_depth_mm"));
  text.replace(text.find("helix_deg = 30"), 14, "point_angle_deg = 118");
  const CutSection drill = read_cutting_model(text, "cuts.toml")[0];
  CHECK(drill.cutter == "T3");
  CHECK(drill.material == "alu");
  CHECK(drill.model.axial_depth == 0);
  CHECK(drill.model.mill.point_angle == doctest::Approx(118 * deg));
  CHECK(drill.model.mill.thrust_share == usual_thrust_share);
}
