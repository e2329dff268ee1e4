// The turn about the spindle axis: chosen for an arm whose spindle hangs under its flange.
#include "counterflex/compensation/spin_search.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "compensation/solve/solver.hpp"
#include "compensation/support/arm.hpp"
#include "compensation/support/window_run.hpp"
#include "counterflex/statics/arm_margins.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// The arm with its flange level and the spindle below it, so that a turn about the spindle moves the arm.
std::string hanging_text(const std::string& travel_of_axis_4 = "") {
  std::string text = replaced(read_file(robot), "xyz_mm = [250, 0, 120]", "xyz_mm = [200, 0, -180]");
  text = replaced(text, "home_deg = 60", "home_deg = -30");
  return replaced(text,
                  "{ actuator = \"revolute\", axis = \"x\" },\n  { compliance = \"revolute\", axis = \"x\", "
                  "compliance_rad_per_Nm = 3.002e-6 }",
                  "{ actuator = \"revolute\", axis = \"x\"" + travel_of_axis_4 +
                      " },\n  { compliance = \"revolute\", axis = \"x\", compliance_rad_per_Nm = 3.002e-6 }");
}

constexpr char outline[] =
    "DEF part( )\n"
    "$VEL.CP=0.025\n"
    "PTP {X 0.0,Y 0.0,Z 40.0,A 0.0,B 0.0,C 0.0}\n"
    "LIN {X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0} C_DIS\n"
    "LIN {X 120.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0} C_DIS\n"
    "LIN {X 120.0,Y 60.0,Z 0.0,A 0.0,B 0.0,C 0.0} C_DIS\n"
    "LIN {X 100.0,Y 70.0,Z 4.0,A 0.0,B 4.0,C 2.0} C_DIS\n"
    "LIN {X 80.0,Y 75.0,Z 4.0,A 0.0,B 6.0,C 3.0} C_DIS\n"
    "LIN {X 0.0,Y 60.0,Z 0.0,A 0.0,B 0.0,C 0.0} C_DIS\n"
    "LIN {X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0} C_DIS\n"
    "PTP {X 0.0,Y 0.0,Z 40.0,A 0.0,B 0.0,C 0.0}\n"
    "END\n";

Order order_of(const std::string& machine = hanging_text(), const std::string& text = outline) {
  Order order{.machine = read_machine(machine, "hanging.toml"), .text = text};
  order.force = constant_force((Vector6() << 40, -150, -60, 0, 0, 0).finished());
  order.max_correction = 20e-3;
  order.X_MW = translation(Vector3(1.95, -0.03, 0.98));
  order.read.dialect = "kuka";
  return order;
}

SpinChoice choice_for(const Order& order, std::size_t least_moves = whole_program) {
  WindowShop shop(order, least_moves);
  return best_spins(*shop.windows, order.threads, [](const Job&) {});
}

/// A program as it is to be commanded with turns, without a correction.
struct Predicted {
  double largest = 0;  ///< m
  std::vector<Waypoint> waypoints{};
  std::optional<Failure> failure{};
};

Predicted predicted(const Order& order, const std::vector<double>& spins) {
  WindowShop shop(order, whole_program, {}, &spins);
  WindowRun run;
  Predicted result;
  result.failure = predict_windows(*shop.windows, 1, events_for(run));
  for (const Waypoint& w : run.waypoints)
    if (w.cutting) result.largest = std::max(result.largest, w.after.head<3>().norm());
  result.waypoints = std::move(run.waypoints);
  return result;
}

/// Angles to the nearest other configuration, and joint values, at the places of a path.
struct Posture {
  double margin = 0;
  Eigen::VectorXd rho;
};

std::vector<Posture> postures(const Order& order, const std::vector<double>& spins) {
  WindowShop shop(order, whole_program, {}, &spins);
  JobWindow window;
  REQUIRE(shop.windows->next(window));
  const Job job = shop.windows->job(window);
  PlaceSolver solver(job);
  std::vector<Posture> all;
  for (const Segment& segment : job.path.segments)
    for (double u = 0; u <= 1; u += 1.0 / 64) {
      const NominalResult there =
          solver.nominal({&job.model, point_at(segment.wanted, u), orientation_at(segment, u)});
      REQUIRE(there.status == Status::converged);
      all.push_back({arm_margin(job.model, there.configuration)->angle,
                     actuator_values(job.model.mechanism, there.configuration)});
    }
  return all;
}

double least_margin(const std::vector<Posture>& all) {
  double least = HUGE_VAL;
  for (const Posture& posture : all) least = std::min(least, posture.margin);
  return least;
}

std::vector<double> none(const SpinChoice& choice) {
  return std::vector<double>(choice.at_end.size(), 0.0);
}

}  // namespace

TEST_CASE("turned targets keep the tip and the axis of the program, also between them") {
  const Order order = order_of();
  const SpinChoice choice = choice_for(order);
  REQUIRE(choice.turned > 4);
  WindowShop plain(order, whole_program), shop(order, whole_program, {}, &choice.at_end);
  JobWindow programmed, turned;
  REQUIRE(plain.windows->next(programmed));
  REQUIRE(shop.windows->next(turned));
  REQUIRE(programmed.path.segments.size() == turned.path.segments.size());
  double largest = 0;
  for (std::size_t s = 0; s < turned.path.segments.size(); ++s) {
    const Segment &wanted = programmed.path.segments[s], &found = turned.path.segments[s];
    for (const double u : {0.0, 0.2, 0.5, 0.8, 1.0}) {
      CAPTURE(wanted.line);
      CAPTURE(u);
      CHECK((point_at(found.wanted, u) - point_at(wanted.wanted, u)).norm() < 1e-9);
      const Matrix3 R = *orientation_at(found, u), R_wanted = *orientation_at(wanted, u);
      const double tilted = (R.col(2) - R_wanted.col(2)).norm();
      const bool inside = u > 0 && u < 1;
      CHECK(tilted < (inside ? spin_tilt_share * 0.02 * deg : 1e-9));
      if (!wanted.cutting && inside) continue;
      largest = std::max(largest, rotation_between(R, R_wanted).norm());
    }
    const double turn = choice.at_end[wanted.move];
    const Matrix3 expected = *orientation_at(wanted, 1) * exp_so3(turn * Vector3::UnitZ());
    CHECK((*orientation_at(found, 1) - expected).norm() < 1e-9);
  }
  CHECK(largest > 4 * deg);
}

TEST_CASE("the turn lowers the largest deviation, below that of every constant turn that is allowed") {
  const Order order = order_of();
  const SpinChoice choice = choice_for(order);
  const std::vector<double> programmed = none(choice);
  const Predicted before = predicted(order, programmed), turned = predicted(order, choice.at_end);
  REQUIRE(!before.failure);
  REQUIRE(!turned.failure);
  CAPTURE(fmt::format("{:.4f} mm -> {:.4f} mm, {:.0f} to {:.0f} deg", before.largest / mm,
                      turned.largest / mm, choice.least / deg, choice.most / deg));
  CHECK(turned.largest < 0.98 * before.largest);
  const double margin = least_margin(postures(order, programmed));
  int compared = 0;
  for (double turn = -90; turn <= 90; turn += 15) {
    const std::vector<double> constant(programmed.size(), turn * deg);
    CAPTURE(turn);
    const Predicted there = predicted(order, constant);
    if (there.failure || least_margin(postures(order, constant)) < margin) continue;
    CHECK(turned.largest <= there.largest + 0.012 * before.largest);
    ++compared;
  }
  CHECK(compared >= 2);
}

TEST_CASE("the arm moves continuously, no closer to another configuration, and away from its travel") {
  const Order order = order_of();
  const SpinChoice free = choice_for(order);
  const std::vector<Posture> programmed = postures(order, none(free)), turned = postures(order, free.at_end);
  CHECK(least_margin(turned) > least_margin(programmed) - 1e-3);
  double least = HUGE_VAL, most = -HUGE_VAL, step = 0, programmed_step = 0;
  for (std::size_t i = 0; i < turned.size(); ++i) {
    least = std::min(least, turned[i].rho[3]);
    most = std::max(most, turned[i].rho[3]);
    if (i == 0) continue;
    step = std::max(step, (turned[i].rho - turned[i - 1].rho).cwiseAbs().maxCoeff());
    programmed_step =
        std::max(programmed_step, (programmed[i].rho - programmed[i - 1].rho).cwiseAbs().maxCoeff());
  }
  CHECK(step < programmed_step + 5 * deg);
  // With axis 4 stopped closer to the programmed posture than the turn went.
  const double reached = std::max(-least, most), allowed = 0.6 * reached / deg + 5;
  REQUIRE(reached > 4 * deg);
  const Order narrow = order_of(hanging_text(fmt::format(", min_deg = {}, max_deg = {}", -allowed, allowed)));
  const SpinChoice held = choice_for(narrow);
  CHECK(held.turned > 0);
  for (const Posture& posture : postures(narrow, held.at_end))
    CHECK(std::abs(posture.rho[3]) < (allowed - 5) * deg + 0.2 * deg);
}

TEST_CASE("the arm comes no closer to another configuration, also where axis 4 lets it go only there") {
  for (const double y : {-0.7, 0.7})
    for (const char* travel : {", min_deg = -6, max_deg = 75", ", min_deg = -75, max_deg = 6"}) {
      CAPTURE(y);
      CAPTURE(std::string(travel));
      Order order = order_of(hanging_text(travel));
      order.X_MW = translation(Vector3(1.75, y, 0.98));
      const SpinChoice choice = choice_for(order);
      const double programmed = least_margin(postures(order, none(choice)));
      CHECK(least_margin(postures(order, choice.at_end)) > programmed - 0.02 * deg);
    }
}

TEST_CASE("the corrected program is verified with the turns and, against the program alone, without them") {
  const Order order = order_of();
  const SpinChoice choice = choice_for(order);
  WindowRun run;
  {
    WindowShop shop(order, whole_program, {}, &choice.at_end);
    run.failure =
        compensate_windows(*shop.windows, shop.options, TextReader(shop.reader), false, events_for(run));
  }
  if (run.failure) FAIL_CHECK(run.failure->what);
  REQUIRE(!run.failure);
  for (const Waypoint& w : run.waypoints) CHECK(w.after.head<3>().norm() < order.tolerance);
  const auto verdict = [&](const std::vector<double>* spins, const std::string& text) {
    WindowShop shop(order, whole_program, {}, spins);
    FileReader bytes = FileReader::of_bytes(text);
    ProgramReader corrected(bytes, "out.src", order.read);
    WindowRun judged;
    const auto failure = verify_windows(*shop.windows, 1, corrected, false, events_for(judged));
    return failure;
  };
  CHECK(!verdict(&choice.at_end, run.text));
  CHECK(!verdict(nullptr, run.text));
  CHECK(verdict(nullptr, order.text));
}

TEST_CASE("the turns do not depend on threads, and turns of zero change nothing") {
  Order order = order_of();
  const SpinChoice choice = choice_for(order);
  order.threads = 3;
  CHECK(choice_for(order).at_end == choice.at_end);
  const std::vector<double> zeros = none(choice);
  const auto text_with = [&](const std::vector<double>* spins) {
    WindowShop shop(order, whole_program, {}, spins);
    WindowRun run;
    run.failure =
        compensate_windows(*shop.windows, shop.options, TextReader(shop.reader), false, events_for(run));
    REQUIRE(!run.failure);
    return run.text;
  };
  CHECK(text_with(nullptr) == text_with(&zeros));
}

TEST_CASE("a force in axes of the tool stays where it is in the world while the flange turns") {
  Order order = order_of();
  order.force.rules = read_force_csv(
      "# frame = tool\n# sense = on_tool\ns_mm, fx_N, fy_N, fz_N\n0, 100, 20, -5\n", "forces.csv");
  const std::vector<double> quarter(12, 60 * deg);
  WindowShop plain(order, whole_program), shop(order, whole_program, {}, &quarter);
  JobWindow programmed, turned;
  REQUIRE(plain.windows->next(programmed));
  REQUIRE(shop.windows->next(turned));
  double largest = 0;
  for (std::size_t s = 0; s < turned.path.segments.size(); ++s)
    for (const double u : {0.3, 0.9}) {
      const Vector6 F = programmed.forces->at(s, u, Side::before);
      CHECK((turned.forces->at(s, u, Side::before) - F).norm() < 1e-9);
      largest = std::max(largest, F.norm());
    }
  CHECK(largest > 90);
}

TEST_CASE("a path that begins at a target in joint values begins as programmed, and turns by its way") {
  Order order = order_of(hanging_text(), replaced(outline, "PTP {X 0.0,Y 0.0,Z 40.0,A 0.0,B 0.0,C 0.0}\n",
                                                  "PTP {A1 0,A2 -78,A3 108,A4 0,A5 -30,A6 0}\n"));
  order.read.kinematics = [](const JointPlace&, std::int32_t, const ProgramFrame&) {
    return std::optional(Pose{Matrix3::Identity(), Vector3(0, 0, 40)});  // in the frame of the program, mm
  };
  const SpinChoice choice = choice_for(order);
  REQUIRE(choice.turned > 0);
  WindowShop shop(order, whole_program, {}, &choice.at_end);
  JobWindow window;
  REQUIRE(shop.windows->next(window));
  double before = 0;
  for (const Segment& segment : window.path.segments) {
    const MoveOrientation& orientation = *window.program.moves[segment.move].orientation;
    CAPTURE(segment.line);
    CHECK(std::abs(orientation.start_spin - before) < 1e-12);
    if (segment.cutting)
      CHECK(std::abs(orientation.end_spin - orientation.start_spin) <=
            0.5 * deg / mm * length(segment.wanted) + 1e-9);
    before = orientation.end_spin;
  }
}

TEST_CASE("a program whose control would tilt the tool, or turns it itself, is refused with the line") {
  const auto refusal = [](const std::string& dialect, const std::string& text) {
    Order order = order_of(hanging_text(), text);
    order.read.dialect = dialect;
    order.read.tool_orientation = true;
    try {
      choice_for(order);
    } catch (const InputError& error) {
      return fmt::format("{}: {}", error.where().line, error.what());
    }
    return std::string();
  };
  const std::string angles =
      refusal("linuxcnc", "G21 G90 G94\nG0 X0 Y0 Z40 A0 B0 C0\nG1 Z0 F500\nX50\nM30\n");
  CAPTURE(angles);
  CHECK(angles.starts_with(
      "2: part.ngc:2:1: error: --free spin cannot turn this target: the control changes A, B and C evenly"));
  const std::string axis = refusal(
      "apt", "PARTNO part\nMULTAX\nUNITS/MM\nFEDRAT/500,MMPM\nGOTO/0,0,40,0,0,1\nGOTO/50,0,0,0,0,1\nFINI\n");
  CHECK(axis.find("the program gives the axis of the tool") != std::string::npos);
}
