#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "forces/sample_path.hpp"

using namespace counterflex;
using test::forces_on;
using test::from_csv;
using test::linear;
using test::near;
using test::on_tool;
using test::ProgramBuilder;
using test::sample_program;
using test::straight;
using test::wrench;

TEST_CASE("line and block number rows hold from their block until the next row's") {
  const std::string forces_2_4 = ",100,0,0\n", forces_6 = ",50,0,0\n";
  for (const auto& text : {"line,fx_N,fy_N,fz_N\n2" + forces_2_4 + "6" + forces_6,
                           "n,fx_N,fy_N,fz_N\n15" + forces_2_4 + "41" + forces_6}) {
    const auto forces = forces_on(sample_program(), from_csv(on_tool + text));
    CHECK(forces.at(1, 0.5) == wrench(100, 0, 0));
    CHECK(forces.at(2, 0.5) == wrench(100, 0, 0));
    CHECK(forces.at(4, 1) == wrench(100, 0, 0));
    CHECK(forces.at(5, 0) == wrench(50, 0, 0));
    CHECK(forces.jumps() == 3);
  }
}

TEST_CASE("linear interpolation over lines gives each block one force") {
  const auto forces =
      forces_on(sample_program(), from_csv(linear + "line,fx_N,fy_N,fz_N\n1,0,0,0\n6,50,0,0\n"));
  for (const double f : {0.0, 1.0}) {
    CHECK(near(forces.at(1, f), wrench(10, 0, 0)));
    CHECK(near(forces.at(4, f), wrench(40, 0, 0)));
    CHECK(near(forces.at(5, f), wrench(50, 0, 0)));
  }
}

TEST_CASE("a constant stretch of a linear profile ends where the slope begins") {
  const auto forces =
      forces_on(straight(10, 5), from_csv(linear + "s_mm,fx_N,fy_N,fz_N\n0,10,0,0\n5,10,0,0\n10,20,0,0\n"));
  CHECK(forces.at(0, 0.9) == wrench(10, 0, 0));
  CHECK(near(forces.at(1, 0.5), wrench(15, 0, 0)));
}

TEST_CASE("a row a rounding error before the end of a segment acts at the end") {
  ForceSource source;
  source.blend = 0;
  ForceProfile profile;
  profile.key = ForceKey::time;
  profile.linear = true;
  const Program program = straight(2, 1);
  const double t = build_toolpath(program, one_frame(program, {})).segments[0].t_end, end = 2 * t;
  profile.rows = {
      {0, wrench(1, 0, 0), {}}, {std::nextafter(t, 0.0), wrench(2, 0, 0), {}}, {end, wrench(5, 0, 0), {}}};
  source.rules = {{"forces.csv", {}, {}, profile}};
  const auto forces = forces_on(program, source);
  CHECK(near(forces.at(0, 1), wrench(2, 0, 0)));
  CHECK(near(forces.at(1, 0), wrench(2, 0, 0)));
  CHECK(near(forces.at(1, 0.5), wrench(3.5, 0, 0)));
  CHECK(forces.breaks(0).empty());
  source.blend = 0.5 * mm;
  CHECK(near(forces_on(program, source).at(1, 0.5), wrench(2.75, 0, 0)));
}

TEST_CASE("a linear profile runs through its rows, in length and in time") {
  for (const auto& keys : {std::string("s_mm,fx_N,fy_N,fz_N\n0,0,0,0\n4,40,0,0\n10,10,0,0\n"),
                           std::string("t_s,fx_N,fy_N,fz_N\n0,0,0,0\n0.4,40,0,0\n1,10,0,0\n")}) {
    const auto forces = forces_on(straight(10, 5), from_csv(linear + keys));
    CHECK(near(forces.at(0, 0.4), wrench(20, 0, 0)));
    CHECK(near(forces.at(0, 0.8), wrench(40, 0, 0)));
    CHECK(near(forces.at(1, 0), wrench(35, 0, 0)));
    CHECK(near(forces.at(1, 1), wrench(10, 0, 0)));
    REQUIRE(forces.breaks(0).size() == 1);
    CHECK(forces.breaks(0)[0] == doctest::Approx(0.8));
    CHECK(forces.jumps() == 0);
  }
}

TEST_CASE("a step in time acts at the place of the tool at that time, for any feeds") {
  const Program program =
      ProgramBuilder({0, 0, 0}).feed({10, 0, 0}, 600).feed({20, 0, 0}, 300).program;  // 1 s, 2 s
  const auto forces =
      forces_on(program, from_csv(on_tool + "t_s,fx_N,fy_N,fz_N\n0,1,0,0\n0.5,2,0,0\n2,3,0,0\n"));
  REQUIRE(forces.breaks(0).size() == 1);
  CHECK(forces.breaks(0)[0] == doctest::Approx(0.5));
  REQUIRE(forces.breaks(1).size() == 1);
  CHECK(forces.breaks(1)[0] == doctest::Approx(0.5));
}

TEST_CASE("work and tool frames turn forces and moments by the part's and the tool's orientation") {
  const Pose X_MW = rotation(exp_so3({0, 0, 90 * deg}));
  const Matrix3 R_MT = exp_so3({90 * deg, 0, 0});
  const std::string rows = "# sense = on_tool\nline,fx_N,fy_N,fz_N,mx_Nm,my_Nm,mz_Nm\n1,1,2,3,4,5,6\n";
  const auto work = forces_on(sample_program(), from_csv("# frame = work\n" + rows), X_MW, R_MT);
  CHECK(near(work.at(2, 0.5), wrench(-2, 1, 3, -5, 4, 6)));
  const auto tool = forces_on(sample_program(), from_csv("# frame = tool\n" + rows), X_MW, R_MT);
  CHECK(near(tool.at(2, 0.5), wrench(1, -3, 2, 4, -6, 5)));
}

TEST_CASE("each segment may have its own tool orientation") {
  const Program program = straight(2, 1);
  const auto path = build_toolpath(program, one_frame(program, {}));
  const auto source = from_csv("# frame = tool\n# sense = on_tool\nline,fx_N,fy_N,fz_N\n1,1,0,0\n");
  const PathForces forces(source, program, path, {Matrix3::Identity(), exp_so3({0, 0, 90 * deg})});
  CHECK(near(forces.at(0, 1), wrench(1, 0, 0)));
  CHECK(near(forces.at(1, 0), wrench(0, 1, 0)));
}

TEST_CASE("in the feed frame x follows the feed, z is the tool's, and a plunge keeps z only and is listed") {
  const auto source =
      from_csv("# frame = feed\n# sense = on_tool\nline,fx_N,fy_N,fz_N,mx_Nm,my_Nm,mz_Nm\n1,1,2,3,4,5,6\n");
  const auto forces = forces_on(sample_program(), source);
  CHECK(near(forces.at(1, 0.5), wrench(0, 0, 3, 0, 0, 6)));
  CHECK(near(forces.at(2, 0.5), wrench(1, 2, 3, 4, 5, 6)));    // along x
  CHECK(near(forces.at(4, 0.5), wrench(-2, 1, 3, -5, 4, 6)));  // along y
  CHECK(near(forces.at(5, 0.5), wrench(-1, -2, 3, -4, -5, 6)));
  REQUIRE(forces.notes().size() == 1);
  CHECK(forces.notes()[0].line == 2);
}

TEST_CASE("the z axis of the feed frame of a slanted cut is the tool's axis") {
  const Program ramp = ProgramBuilder({0, 0, 0}).feed({10, 0, -5}, 600).program;
  const auto forces =
      forces_on(ramp, from_csv("# frame = feed\n# sense = on_tool\nline,fx_N,fy_N,fz_N\n1,1,2,3\n"));
  CHECK(near(forces.at(0, 0.5), wrench(1, 2, 3)));
  CHECK(forces.notes().empty());
}

TEST_CASE("a plunge with an axial force only is not listed") {
  const auto forces = forces_on(
      sample_program(), from_csv("# frame = feed\n# sense = on_tool\nline,fx_N,fy_N,fz_N\n1,0,0,3\n"));
  CHECK(forces.notes().empty());
  CHECK(near(forces.at(1, 0.5), wrench(0, 0, 3)));
}
