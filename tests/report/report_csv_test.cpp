#include <doctest/doctest.h>

#include <algorithm>

#include "counterflex/report/formats.hpp"
#include "made_up_run.hpp"
#include "support/text.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

std::string csv_of(const std::vector<Waypoint>& waypoints, const CsvColumns& columns) {
  std::size_t next_index = 0;
  return csv_header() + csv_rows(waypoints, columns, next_index);
}

}  // namespace

TEST_CASE("the CSV has the documented columns and a row for every waypoint that is not between") {
  std::vector<Waypoint> waypoints = {cut(0, 4, 1, Vector3(1, 0, 0)), cut(0, 4, 1, Vector3(0.1, -0.2, 0.3))};
  waypoints[0].between = true;
  waypoints[0].place = false;
  waypoints[1].s = 0.1;
  waypoints[1].p_MT = Vector3(0.001, 0.002, -0.003);
  waypoints[1].before.tail<3>() = Vector3(0.5, -0.25, 0) * deg;
  const auto lines = lines_of(csv_of(waypoints, {}));
  REQUIRE(lines.size() == 2);
  CHECK(
      lines[0] ==
      "index,line,cutting,s_mm,x_mm,y_mm,z_mm,fx_N,fy_N,fz_N,mx_Nm,my_Nm,mz_Nm,"
      "before_dx_mm,before_dy_mm,before_dz_mm,before_drx_deg,before_dry_deg,before_drz_deg,"
      "geometry_dx_mm,geometry_dy_mm,geometry_dz_mm,geometry_drx_deg,geometry_dry_deg,geometry_drz_deg,"
      "load_dx_mm,load_dy_mm,load_dz_mm,load_drx_deg,load_dry_deg,load_drz_deg,"
      "gravity_dx_mm,gravity_dy_mm,gravity_dz_mm,gravity_drx_deg,gravity_dry_deg,gravity_drz_deg,"
      "preloads_dx_mm,preloads_dy_mm,preloads_dz_mm,preloads_drx_deg,preloads_dry_deg,preloads_drz_deg,"
      "superposition_dx_mm,superposition_dy_mm,superposition_dz_mm,"
      "superposition_drx_deg,superposition_dry_deg,superposition_drz_deg,"
      "after_dx_mm,after_dy_mm,after_dz_mm,after_drx_deg,after_dry_deg,after_drz_deg,"
      "air_dx_mm,air_dy_mm,air_dz_mm,air_drx_deg,air_dry_deg,air_drz_deg,"
      "correction_x_mm,correction_y_mm,correction_z_mm,correction_rx_deg,correction_ry_deg,correction_rz_deg,"
      "status,iterations,rx_deg,ry_deg,rz_deg");
  const std::string zeros = ",0.0000000,0.0000000,0.0000000";
  CHECK(lines[1] ==
        "0,4,1,100.000000,1.000000,2.000000,-3.000000,30.000000,-40.000000,0.000000,0.000000,0.000000,2."
        "000000,"
        "0.1000000,-0.2000000,0.3000000,0.5000000,-0.2500000,0.0000000,"
        "0.0250000,-0.0500000,0.0750000" +
            zeros + ",0.0500000,-0.1000000,0.1500000" + zeros + zeros + zeros + zeros + zeros +
            ",0.0750000,-0.1500000,0.2250000" + zeros + ",0.0010000,-0.0020000,0.0030000" + zeros +
            ",-0.0500000,0.1000000,-0.1500000" + zeros + ",-0.1000000,0.2000000,-0.3000000" + zeros +
            ",converged,7,,,");
}

TEST_CASE("the programmed orientation is a rotation vector in degrees") {
  std::vector<Waypoint> waypoints = {cut(0, 4, 1, Vector3(1, 0, 0))};
  waypoints[0].R_MT = Matrix3(Eigen::AngleAxisd(90 * deg, Vector3::UnitY()));
  CHECK(lines_of(csv_of(waypoints, {}))[1].ends_with(",converged,7,0.0000000,90.0000000,0.0000000"));
}

TEST_CASE("rows of a CSV written in portions equal those written at once") {
  std::vector<Waypoint> waypoints = made_up_waypoints();
  const std::string all = csv_of(waypoints, {});
  for (std::size_t cut_at = 0; cut_at <= waypoints.size(); ++cut_at) {
    CAPTURE(cut_at);
    const auto middle = waypoints.begin() + static_cast<std::ptrdiff_t>(cut_at);
    std::size_t next_index = 0;
    std::string text = csv_header() + csv_rows({waypoints.begin(), middle}, {}, next_index);
    text += csv_rows({middle, waypoints.end()}, {}, next_index);
    CHECK(text == all);
    CHECK(next_index == 4);
  }
}

TEST_CASE("the columns of the fixture are the last ones, and only of machines that have one") {
  std::vector<Waypoint> waypoints = {cut(0, 4, 1, Vector3(1, 2, 3))};
  waypoints[0].causes->fixture.head<3>() = Vector3(0.5, -0.25, 0) * mm;
  std::size_t next_index = 0;
  const CsvColumns columns{.fixture = true};
  const std::string with = csv_header(columns) + csv_rows(waypoints, columns, next_index);
  const auto lines = lines_of(with), without = lines_of(csv_of(waypoints, {}));
  CHECK(lines[0] == without[0] +
                        ",fixture_dx_mm,fixture_dy_mm,fixture_dz_mm,fixture_drx_deg,fixture_dry_deg,"
                        "fixture_drz_deg");
  CHECK(lines[1].ends_with(",0.5000000,-0.2500000,0.0000000,0.0000000,0.0000000,0.0000000"));
}

TEST_CASE("columns that were not computed keep their place and are empty") {
  std::vector<Waypoint> waypoints = {cut(0, 4, 1, Vector3(1, 2, 3)), cut(0, 4, 1, Vector3(1, 2, 3))};
  waypoints[1].status = Status::singular;
  const auto lines = lines_of(csv_of(waypoints, {true, false}));
  REQUIRE(lines.size() == 3);
  for (const std::string& line : lines) CHECK(std::count(line.begin(), line.end(), ',') == 71);
  CHECK(contains(lines[1], std::string(19, ',') + "converged,7"));
  CHECK(contains(lines[2], ",2.000000" + std::string(55, ',') + "singular,7"));
}
