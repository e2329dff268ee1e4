// The force in holes of cycles: that of a plunge.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "counterflex/program/read_program.hpp"
#include "forces/sample_path.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// A drill of 8 mm in 42CrMo4, and an end mill that does not drill.
const char* const cutters = R"(format = "counterflex-forces 1"
[cutters.drill]
diameter_mm = 8
flutes = 2
point_angle_deg = 118
[cutters.mill]
diameter_mm = 10
flutes = 4
helix_deg = 30
[materials.steel]
kc11_N_mm2 = 1675
mc = 0.24
radial_share = 0.3
axial_share = 0.2
)";

ForceSource sections(const std::string& text) {
  ForceSource source;
  source.rules = read_force_toml(cutters + text, "forces.toml");
  source.blend = 2 * mm;
  return source;
}

const std::string drills_all = "[[section]]\ncutter = \"drill\"\nmaterial = \"steel\"\n";

ForceSource in_frame(ForceFrame frame) {
  ForceSource source = constant(wrench(30, -20, 400, 1, 2, 3), 2 * mm);
  std::get<ConstantForce>(source.rules[0].content).frame = frame;
  return source;
}

Program hole_with(const std::string& cycle, const std::string& dialect = "linuxcnc") {
  ReadOptions read;
  read.dialect = dialect;
  const bool siemens = dialect == "siemens";
  return read_program(std::string(siemens ? "G71 G90" : "G21 G90") +
                          " G17 G54\nT2 M6\nS1200 M3\nF180\nG0 X10 Y20 Z5\n" + cycle +
                          (siemens ? "\nG0 Z30\nM30\n" : "\nG80\nG0 Z30\nM30\n"),
                      "p.nc", read);
}

/// The wrench in the first hole of the program.
Vector6 in_first_hole(const Program& program, const ForceSource& source, const Pose& X_MW = {}) {
  const PathForces forces = forces_on(program, source, X_MW);
  for (std::size_t m = 0; m < program.moves.size(); ++m)
    if (drills(program.moves[m])) return forces.in_hole(m);
  FAIL("there is no hole");
  return Vector6::Zero();
}

/// The wrench at the bottom of the same hole as a feed move.
Vector6 at_end_of_plunge(const ForceSource& source, const Pose& X_MW, const std::string& comment = "") {
  const Program program = read_program("G21 G90 G17 G54\nT2 M6\nS1200 M3\nF180\nG0 X10 Y20 Z5\nG0 Z2\n" +
                                           comment + "G1 Z-12\nG0 Z2\nG0 Z30\nM30\n",
                                       "p.nc", {});
  const PathForces forces = forces_on(program, source, X_MW);
  const Toolpath path = build_toolpath(program, one_frame(program, {{}, X_MW}));
  for (std::size_t i = 0; i < path.segments.size(); ++i)
    if (path.segments[i].cutting) return forces.at(i, 1);
  FAIL("there is no plunge");
  return Vector6::Zero();
}

std::string reason(const Program& program, const ForceSource& source) {
  const PathForces forces = forces_on(program, source);
  REQUIRE(forces.unforced().size() == 1);
  CHECK(forces.unforced()[0].length == 0);
  return forces.unforced()[0].why;
}

}  // namespace

TEST_CASE("the hole of a cycle has the force of a plunge at the same feed") {
  const Pose X_MW{exp_so3({0.1, -0.2, 0.3}), {0.1, 0.2, 0.3}}, level{};
  ForceSource scaled = sections(drills_all);
  scaled.scale = 1.3;
  const std::vector<ForceSource> sources{sections(drills_all),          scaled,
                                         in_frame(ForceFrame::machine), in_frame(ForceFrame::work),
                                         in_frame(ForceFrame::tool),    in_frame(ForceFrame::feed)};
  for (const ForceSource& source : sources) {
    CAPTURE(&source - sources.data());
    for (const Pose& X : {level, Pose{exp_so3({0, 0, 0.4}), {0.1, 0.2, 0.3}}}) {
      const Vector6 plunge = at_end_of_plunge(source, X);
      CHECK(plunge.norm() > 100);
      for (const char* cycle : {"G81 Z-12 R2", "G98 G81 X10 Y20 Z-12 R2", "G83 Z-12 R2 Q3", "G73 Z-12 R2 Q1"})
        CHECK(near(in_first_hole(hole_with(cycle), source, X), plunge));
    }
  }
  CHECK(near(in_first_hole(hole_with("G81 Z-12 R2"), in_frame(ForceFrame::machine), X_MW),
             at_end_of_plunge(in_frame(ForceFrame::machine), X_MW)));
}

TEST_CASE("a FORCE comment acts in holes, and is more specific than a section for the tool") {
  const std::string comment = "(FORCE FX=5 FY=0 FZ=250)\n";
  const ForceSource source = sections(drills_all + "tool = \"T2\"\n");
  CHECK(in_first_hole(hole_with(comment + "G81 Z-12 R2"), source) == wrench(5, 0, 250));
  CHECK(at_end_of_plunge(source, {}, comment) == wrench(5, 0, 250));
}

TEST_CASE("retracts and the ways between holes have no force") {
  const Program program = hole_with("G99 G81 Z-12 R2\nX30\nX50 Z-9");
  const PathForces forces = forces_on(program, sections(drills_all));
  const Toolpath path = build_toolpath(program, one_frame(program, {}));
  std::size_t holes = 0;
  for (std::size_t m = 0; m < program.moves.size(); ++m) {
    CHECK((forces.in_hole(m).norm() > 100) == drills(program.moves[m]));
    holes += drills(program.moves[m]);
  }
  CHECK(holes == 3);
  for (std::size_t i = 0; i < path.segments.size(); ++i)
    for (const double u : {0.0, 0.5, 1.0}) CHECK(forces.at(i, u).isZero(0));
  CHECK(forces.unforced().empty());
}

TEST_CASE("each hole of a block with repeats counts as one without a force") {
  const Program holes = hole_with("G91 G81 X5 Z-14 R-3 L4");
  const ForceSource of_mill =
      sections("[[section]]\ncutter = \"mill\"\nmaterial = \"steel\"\naxial_depth_mm = 2\nside = \"slot\"\n");
  CHECK(forces_on(holes, of_mill).unforced().size() == 4);
  CHECK(forces_on(holes, sections(drills_all)).unforced().empty());
}

TEST_CASE("a hole without a force is listed with the reason, without a length") {
  const Program hole = hole_with("G81 Z-12 R2");
  CHECK(reason(hole, sections("[[section]]\ncutter = \"mill\"\nmaterial = \"steel\"\naxial_depth_mm = 2\n"
                              "side = \"slot\"\n")) == "the feed is along the tool axis (plunge)");
  CHECK(reason(hole, constant(Vector6::Zero(), 0)) == "the force given for it is zero");
  CHECK(reason(hole, from_csv(on_tool + "line, fx_N, fy_N, fz_N\n1, 0, 0, 300\n")) ==
        "the rows of a profile do not act in holes of cycles");
  CHECK(reason(hole, {}) == "no force is given for it");
  CHECK(reason(hole_with("G81 Z12 R2"), sections(drills_all)) == "the feed is along the tool axis (retract)");
  ForceSource source = sections(drills_all);
  source.air_above_mm = -13;
  CHECK(reason(hole, source) == "it is wholly above --air-above");
  source.air_above_mm = -11;
  CHECK(in_first_hole(hole, source).norm() > 100);
}

TEST_CASE("a rule for a tool that makes holes alone is in use, and two rules of one rank are refused") {
  const Program program = read_program(
      "G21 G90 G17 G54\nT1 M6\nS1200 M3\nF180\nG0 X10 Y20 Z5\nG1 X20\nG0 Z20\nT2 M6\nG0 X0 Y0 Z5\nG81 Z-12 "
      "R2\n"
      "G80\nM30\n",
      "p.nc", {});
  const std::string mill =
      "[[section]]\ntool = \"T1\"\ncutter = \"mill\"\nmaterial = \"steel\"\n"
      "axial_depth_mm = 2\nside = \"slot\"\n";
  const std::string drill = drills_all + "tool = \"T2\"\n";
  CHECK(in_first_hole(program, sections(mill + drill)).norm() > 100);
  CHECK(in_first_hole(program, sections(mill)).isZero(0));  // a hole needs no rule
  CHECK_THROWS_WITH_AS(in_first_hole(program, sections(mill + drill + drill)),
                       doctest::Contains("line 10 of the program"), InputError);
}

TEST_CASE("a Sinumerik drills with F, bores with FFR, and taps with its spindle") {
  const auto thrust = [](const std::string& call) {
    return in_first_hole(hole_with(call, "siemens"), sections(drills_all)).z();
  };
  const double at_180 = at_end_of_plunge(sections(drills_all), {}).z();
  CHECK(thrust("CYCLE81(10,0,2,-12)") == doctest::Approx(at_180));
  CHECK(thrust("CYCLE83(10,0,2,-12,,-3,,1,0,0,1,0)") == doctest::Approx(at_180));
  CHECK(thrust("CYCLE85(10,0,2,-12,,0,180,400)") == doctest::Approx(at_180));
  CHECK(thrust("CYCLE85(10,0,2,-12,,0,90,400)") == doctest::Approx(at_180 * std::pow(0.5, 0.76)));
  CHECK(thrust("CYCLE84(10,0,2,-12,,0,3,,1.25,0,400,400)") == 0);
  CHECK(thrust("MCALL CYCLE81(10,0,2,-12)\nX20 Y20\nMCALL") == doctest::Approx(at_180));
}

TEST_CASE("FFR of CYCLE85 has the unit of F, and is per minute") {
  ReadOptions inches;
  inches.dialect = "siemens";
  inches.unit = LengthUnit::inches;
  const auto thrust = [&](const std::string& units, const std::string& ffr, const ReadOptions& options) {
    const std::string text = units +
                             " G90 G17 G54\nT1 M6\nS1200 M3 F180\nG0 X10 Y20 Z10\nCYCLE85(10,0,2,-12,,0," +
                             ffr + ",400)\nM30\n";
    return in_first_hole(read_program(text, "p.mpf", options), sections(drills_all)).z();
  };
  const double at_180 = at_end_of_plunge(sections(drills_all), {}).z();
  CHECK(thrust("G710", "180", inches) == doctest::Approx(at_180));
  CHECK(thrust("G71", "7.0866142", inches) == doctest::Approx(at_180));
  inches.unit = LengthUnit::millimetres;
  CHECK(thrust("G71", "180", inches) == doctest::Approx(at_180));
  CHECK(thrust("G95 G710", "0.15", inches) == 0);
}

TEST_CASE("klartext: a hole is drilled with Q206 of its cycle, from its definition or set later") {
  const auto thrust = [](const std::string& cycle, const std::string& feed, const std::string& later = "") {
    ReadOptions read;
    read.dialect = "heidenhain";
    const Program program =
        read_program("BEGIN PGM A MM\nTOOL CALL 2 Z S1200\nCYCL DEF " + cycle + " ~\nQ200=2 ~\nQ201=-12 ~\n" +
                         feed + "Q203=+0 ~\nQ204=50\n" + later +
                         "L X+10 Y+20 Z+50 R0 FMAX F900\nCYCL CALL\nL Z+100 R0 FMAX M30\nEND PGM A MM\n",
                     "p.h", read);
    const PathForces forces = forces_on(program, sections(drills_all));
    const Toolpath path = build_toolpath(program, one_frame(program, {}));
    for (std::size_t i = 0; i < path.segments.size(); ++i) {
      if (!program.moves[path.segments[i].move].makes_hole) continue;
      CHECK(forces.at(i, 0.5).isZero(0));
      CHECK(forces.at(i, 1) == forces.in_hole(path.segments[i].move));
      return forces.at(i, 1).z();
    }
    FAIL("there is no hole");
    return 0.0;
  };
  const double at_180 = at_end_of_plunge(sections(drills_all), {}).z();
  CHECK(thrust("200 DRILLING", "Q206=180 ~\n") == doctest::Approx(at_180));
  CHECK(thrust("203 UNIVERSAL DRILLING", "Q206=180 ~\n") == doctest::Approx(at_180));
  CHECK(thrust("200 DRILLING", "Q206=90 ~\n", "Q206 = 180\n") == doctest::Approx(at_180));
  CHECK(thrust("200 DRILLING", "Q206=90 ~\n", "FN 0: Q206 = +180\n") == 0);
  CHECK(thrust("200 DRILLING", "Q206=FAUTO ~\n") == 0);
  CHECK(thrust("208 BORE MILLING", "Q206=180 ~\n") == 0);
  CHECK(thrust("200 DRILLING", "") == 0);
}
