// Work offsets and tool data in the words of controls.
#include "counterflex/report/offset_words.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <cstdio>

#include "counterflex/geometry/types.hpp"
#include "counterflex/program/read_program.hpp"

using namespace counterflex;

namespace {

const Pose at = translation(Vector3(150, 100, -240) * mm);
const Vector3 by(-0.04126 * mm, 0.0119 * mm, 0.00001 * mm);

WrittenOffset moved(std::string_view dialect, const std::string& name,
                    LengthUnit unit = LengthUnit::millimetres) {
  return written_offset({dialect, unit}, name, at, translation(by), false);
}

/// The frame of the last move of a program.
ProgramFrame last_frame(const std::string& text, const std::string& dialect) {
  ReadOptions options;
  options.dialect = dialect;
  const Program program = read_program(text, "part", options);
  REQUIRE_FALSE(program.moves.empty());
  return program.frames[program.moves.back().frame];
}

/// A base that is turned a lot, and moved and turned a little.
const Pose base{from_rpy(Vector3(-20, 15, 100) * deg), Vector3(1250.5, -310.25, 640) * mm};
const Pose nudge{exp_so3(Vector3(1e-4, -2e-4, 3e-4)), Vector3(0.1, -0.2, 0.3) * mm};

void check_same(const Pose& pose_mm, const Pose& X_MW) {
  CHECK((pose_mm.p * mm - X_MW.p).norm() < 1e-12);
  CHECK(rotation_between(pose_mm.R, X_MW.R).norm() < 1e-9);
}

/// Rounding moves the base by no more than half its last digits.
WrittenOffset turned(std::string_view dialect, const std::string& name) {
  WrittenOffset written = written_offset({dialect}, name, base, nudge, true);
  const Pose exact = nudge * base;
  CHECK((written.X_MW.p - exact.p).norm() < 1e-6);
  CHECK(rotation_between(written.X_MW.R, exact.R).norm() < 3e-7);
  return written;
}

}  // namespace

TEST_CASE(
    "the words of G-code controls are the present value and the rounded change, in changed axes alone") {
  const WrittenOffset linuxcnc = moved("linuxcnc", "G54");
  CHECK(linuxcnc.words == std::vector<std::string>{"G10 L2 P1 X149.9587 Y100.0119"});
  CHECK(linuxcnc.change == "X-0.0413 Y+0.0119 mm");
  CHECK((linuxcnc.X_MW.p - Vector3(149.9587, 100.0119, -240) * mm).norm() < 1e-12);
  CHECK(moved("linuxcnc", "G59.2").words.at(0).starts_with("G10 L2 P8 X"));
  CHECK(moved("fanuc", "G55").words.at(0) == "G90 G10 L2 P2 X149.959 Y100.012");
  CHECK(moved("fanuc", "G54.1 P3").words.at(0) == "G90 G10 L20 P3 X149.959 Y100.012");
  CHECK(moved("haas", "G54.1 P12").words.at(0) == "G90 G10 L20 P12 X149.959 Y100.012");
  CHECK(moved("grbl", "G54").words.at(0) == "G10 L2 P1 X149.959 Y100.012");
  CHECK(moved("siemens", "G54").words ==
        std::vector<std::string>{"$P_UIFR[1,X,TR]=149.9587", "$P_UIFR[1,Y,TR]=100.0119"});
  CHECK(moved("siemens", "G505").words.at(0).starts_with("$P_UIFR[5,X,TR]="));
  CHECK(moved("heidenhain", "G54").words.at(0) == "preset table, active row: X149.9587 Y100.0119");
  CHECK(moved("linuxcnc", "fixture").words.empty());
  CHECK(written_offset({"linuxcnc"}, "G54", at, Pose{}, false).change == "nothing");
}

TEST_CASE("an inch program gets inches, and digits that the present value has") {
  const WrittenOffset inches = moved("fanuc", "G54", LengthUnit::inches);
  CHECK(inches.change == "X-0.0016 Y+0.0005 inch");
  CHECK((inches.X_MW.p - at.p - Vector3(-0.0016, 0.0005, 0) * inch).norm() < 1e-12);
  const Pose fine = translation(Vector3(1.23456, 2, 3) * mm);
  CHECK(written_offset({"fanuc"}, "G54", fine, translation({1e-6, 0, 0}), false).words.at(0) ==
        "G90 G10 L2 P1 X1.23556");
  CHECK(written_offset({"fanuc", LengthUnit::millimetres, 4}, "G54", at, translation(by), false).change ==
        "X-0.0413 Y+0.0119 mm");
}

TEST_CASE("the reader of each G-code dialect reads the offset from the words") {
  for (const char* dialect : {"linuxcnc", "fanuc", "haas", "grbl", "mach3"}) {
    CAPTURE(dialect);
    const WrittenOffset written = moved(dialect, "G55");
    const ProgramFrame frame = last_frame(
        fmt::format("G21 G90 G17\n{}\nG55\nG1 X1. Y1. Z1. F100.\nX2.\n", written.words.at(0)), dialect);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      REQUIRE(frame.set_mm[axis]);
      CHECK(std::abs(*frame.set_mm[axis] - written.X_MW.p[static_cast<Eigen::Index>(axis)] / mm) < 1e-9);
    }
    CHECK_FALSE(frame.set_mm[2]);
  }
}

TEST_CASE("the reader of Fanuc and Haas reads the further offsets from the words") {
  for (const auto& row :
       {std::array{"fanuc", "G54.1 P3", "G54.1 P3"}, std::array{"haas", "G54.1 P12", "G154 P12"},
        std::array{"haas", "G54.1 P3", "G112"}}) {
    const std::string dialect = row[0], name = row[1], code = row[2];
    CAPTURE(dialect);
    const WrittenOffset written = moved(dialect, name);
    for (const char* text : {"G21 G90 G17\n{0}\n{1}\nG1 X1. Y1. Z1. F100.\nX2.\n",
                             "G21 G90 G17 {1}\n{0}\nG1 X1. Y1. Z1. F100.\nX2.\n"}) {
      const ProgramFrame frame =
          last_frame(fmt::format(fmt::runtime(text), written.words.at(0), code), dialect);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        REQUIRE(frame.set_mm[axis]);
        CHECK(std::abs(*frame.set_mm[axis] - written.X_MW.p[static_cast<Eigen::Index>(axis)] / mm) < 1e-9);
      }
    }
    // Not those of an offset that has the number alone.
    const ProgramFrame other = last_frame(
        fmt::format("G21 G90 G17 G56\n{}\nG1 X1. Y1. Z1. F100.\nX2.\n", written.words.at(0)), dialect);
    CHECK_FALSE(other.set_mm[0]);
    CHECK(other.origin_mm.isZero(0));
  }
}

// "$P_UIFR[n, axis, TR]: the translation of the settable frame n", Programming Manual Job Planning; G54 is
// frame 1, G505 is frame 5.
TEST_CASE("the words of a Sinumerik set the translation of the settable frame") {
  const auto read = [](const std::string& name, int frame) {
    const WrittenOffset written = moved("siemens", name);
    Vector3 p = at.p;
    for (const std::string& words : written.words) {
      int index = 0;
      char axis = 0;
      double value = 0;
      int end = 0;
      REQUIRE(std::sscanf(words.c_str(), "$P_UIFR[%d,%c,TR]=%lf%n", &index, &axis, &value, &end) == 3);
      CHECK(static_cast<std::size_t>(end) == words.size());
      CHECK(index == frame);
      REQUIRE((axis >= 'X' && axis <= 'Z'));
      p[axis - 'X'] = value * mm;
    }
    CHECK((p - written.X_MW.p).norm() < 1e-12);
  };
  read("G54", 1);
  read("G57", 4);
  read("G505", 5);
  read("G599", 99);
}

TEST_CASE("the words of Klartext are columns of the preset table") {
  const WrittenOffset written = moved("heidenhain", "G54");
  double x = 0, y = 0;
  REQUIRE(std::sscanf(written.words.at(0).c_str(), "preset table, active row: X%lf Y%lf", &x, &y) == 2);
  CHECK((Vector3(x, y, at.p.z() / mm) * mm - written.X_MW.p).norm() < 1e-12);
}

TEST_CASE("KUKA reads the base of a program from BASE_DATA in the words, where a data list has them") {
  const WrittenOffset written = turned("kuka", "BASE_DATA[4]");
  const Program program = read_program("DEF part( )\n$BASE=" + written.words.at(0).substr(15) +
                                           "\nLIN {X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}\n"
                                           "LIN {X 9.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}\nEND\n",
                                       "part.src", {.dialect = "kuka"});
  REQUIRE_FALSE(program.moves.empty());
  check_same(*program.frames[program.moves.back().frame].pose_mm, written.X_MW);
}

TEST_CASE("the reader of each robot language reads the base from the words") {
  const WrittenOffset kuka = turned("kuka", "");
  check_same(*last_frame("DEF part( )\n" + kuka.words.at(0) +
                             "\nLIN {X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}\n"
                             "LIN {X 9.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}\nEND\n",
                         "kuka")
                  .pose_mm,
             kuka.X_MW);
  CHECK(turned("kuka", "BASE_DATA[4]").words.at(0).starts_with("BASE_DATA[4] = {X "));

  const WrittenOffset abb = turned("abb", "table");
  REQUIRE(abb.words.size() == 2);
  const auto value = [](const std::string& words) {
    const std::size_t begin = words.find(":= ") + 3;
    return words.substr(begin, words.size() - begin - 1);
  };
  check_same(*last_frame(fmt::format(
                             "MODULE part\nPERS wobjdata table := [FALSE, TRUE, \"\", {}, {}];\nPROC main()\n"
                             "MoveL [[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v100, fine, "
                             "tool0 \\WObj:=table;\nMoveL [[9,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,"
                             "9E9,9E9]], v100, fine, tool0 \\WObj:=table;\nENDPROC\nENDMODULE\n",
                             value(abb.words[0]), value(abb.words[1])),
                         "abb")
                  .pose_mm,
             abb.X_MW);

  const WrittenOffset ur = turned("ur", "part");
  check_same(*last_frame("def panel():\n  " + ur.words.at(0) +
                             "\n  movel(pose_trans(part, p[0, 0, 0, 0, 0, 0]), a=0.5, v=0.1)\n"
                             "  movel(pose_trans(part, p[0.1, 0, 0, 0, 0, 0]), a=0.5, v=0.1)\nend\n",
                         "ur")
                  .pose_mm,
             ur.X_MW);
}

TEST_CASE("UFRAME of FANUC has W, P, R about fixed X, Y, Z") {
  const WrittenOffset tp = turned("tp", "UF 5");
  double x = 0, y = 0, z = 0, w = 0, p = 0, r = 0;
  REQUIRE(std::sscanf(tp.words.at(0).c_str(),
                      "UFRAME[5]: X %lf mm, Y %lf mm, Z %lf mm, W %lf deg, P %lf deg, R %lf deg", &x, &y, &z,
                      &w, &p, &r) == 6);
  check_same({from_rpy(Vector3(w, p, r) * deg), {x, y, z}}, tp.X_MW);
}

TEST_CASE("tools are changed where the control keeps them") {
  const ChangedTool tool{3, 0.0124 * mm, -0.0051 * mm, 80 * mm, 5 * mm};
  using Lines = std::vector<std::string>;
  CHECK(tool_words({"linuxcnc"}, tool) == Lines{"G10 L1 P3 Z80.0124 R4.9949"});
  CHECK(tool_words({"linuxcnc"}, {3, 0.0124 * mm}).empty());
  CHECK(tool_words({"fanuc"}, tool) == Lines{"G90 G10 L11 P3 R0.0124", "G90 G10 L13 P3 R-0.0051"});
  CHECK(tool_words({"haas"}, tool) == Lines{"G90 G10 L11 P3 R0.0124"});
  CHECK(tool_words({"siemens"}, tool) == Lines{"$TC_DP12[3,1]=0.0124", "$TC_DP15[3,1]=-0.0051"});
  CHECK(tool_words({"heidenhain"}, {3, {}, 0.01 * mm}) == Lines{"tool table T3: DR 0.0100"});
  CHECK(tool_words({"grbl"}, tool).empty());
  CHECK(tool_words({"fanuc"}, {0, 0.01 * mm}).empty());
  CHECK(rounded_length({"fanuc"}, 0.01246 * mm) == doctest::Approx(0.012 * mm));
}
