#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "counterflex/program/program_reader.hpp"
#include "forces/sample_path.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr double along[] = {0, 1e-3, 0.2, 0.5, 0.77, 1};

/// The forces on the segments of a program read in windows.
struct Acting {
  std::vector<Vector6> wrenches;
  std::vector<std::vector<double>> breaks;
  std::size_t ramps = 0, jumps = 0, windows = 0, notes = 0;
  double largest_step_N = 0;
};

Acting acting(const std::string& text, const ForceSource& source, std::size_t least_moves) {
  Acting all;
  FileReader bytes = FileReader::of_bytes(text);
  ReadOptions read;
  read.dialect = "linuxcnc";
  read.tool_orientation = true;
  ProgramReader reader(bytes, "p.ngc", read, least_moves);
  PathEnd end;
  ForceTail tail;
  while (reader.next()) {
    const auto path_of_window = [&] {
      return build_toolpath(reader.window(), one_frame(reader.window(), {}), end);
    };
    Toolpath path = path_of_window();
    PathForces forces(source, reader.window(), path, {Matrix3::Identity()}, tail);
    while (!forces.is_final() && reader.extend()) {
      path = path_of_window();
      forces = PathForces(source, reader.window(), path, {Matrix3::Identity()}, tail);
    }
    for (std::size_t i = 0; i < path.segments.size(); ++i) {
      for (const double u : along) all.wrenches.push_back(forces.at(i, u));
      all.breaks.push_back(forces.breaks(i));
    }
    all.ramps += forces.ramps();
    all.jumps += forces.jumps();
    all.notes += forces.notes().size();
    all.largest_step_N = std::max(all.largest_step_N, forces.largest_step_N());
    end = path.end;
    tail = forces.tail();
    ++all.windows;
  }
  return all;
}

void check_same_in_windows(const std::string& text, const ForceSource& source, std::size_t least_windows) {
  CAPTURE(source.blend);
  const Acting whole = acting(text, source, whole_program);
  REQUIRE(whole.windows == 1);
  const Acting parts = acting(text, source, 3);
  CHECK(parts.windows >= least_windows);
  CHECK(parts.ramps == whole.ramps);
  CHECK(parts.jumps == whole.jumps);
  CHECK(parts.notes == whole.notes);
  CHECK(parts.largest_step_N == whole.largest_step_N);
  REQUIRE(parts.wrenches.size() == whole.wrenches.size());
  for (std::size_t i = 0; i < whole.wrenches.size(); ++i) {
    CAPTURE(i);
    CHECK(near(parts.wrenches[i], whole.wrenches[i], 1e-9 * (1 + whole.wrenches[i].norm())));
  }
  for (std::size_t i = 0; i < whole.breaks.size(); ++i) {
    CAPTURE(i);
    REQUIRE(parts.breaks[i].size() == whole.breaks[i].size());
    for (std::size_t k = 0; k < whole.breaks[i].size(); ++k)
      CHECK(parts.breaks[i][k] == doctest::Approx(whole.breaks[i][k]).epsilon(1e-9));
  }
}

/// Feed runs of many lengths in blocks of 0.3 mm, with a plunge before each, and arcs in the last.
std::string many_runs() {
  std::string text = "G21 G90 G17 G0 X0 Y0 Z5\n";
  for (int run = 1; run <= 12; ++run) {
    text += fmt::format("G0 X0 Y{}\nG1 Z-1 F{}\n", run, 100 * run);
    for (int block = 1; block <= 3 * run; ++block) text += fmt::format("X{:.1f}\n", 0.3 * block);
    text += "G0 Z5\n";
  }
  text += "G0 X0 Y0\nG1 Z0\n";
  for (int arc = 0; arc < 6; ++arc)
    text += fmt::format("G3 X{} Y0 I1 J0\nG1 X{}\n", 3 * arc + 2, 3 * arc + 3);
  return text + "G0 Z5\n";
}

/// A different wrench on every line that has one.
std::string rows_by_line(int lines) {
  std::string rows = "line,fx_N,fy_N,fz_N\n";
  for (int line = 1; line <= lines; ++line)
    rows += fmt::format("{},{:.3f},{:.3f},{}\n", line, 100 * std::sin(line), 50 * std::cos(3 * line), -line);
  return rows;
}

}  // namespace

TEST_CASE("forces of a program in windows are those of the whole: constant, by line, by length, by comment") {
  const std::string text = many_runs();
  const int lines = static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  const std::string feed = "# frame = feed\n# sense = on_tool\n";
  for (const double blend : {0.0, 0.5e-3, 2e-3, 5e-3}) {
    check_same_in_windows(text, constant(wrench(30, -20, 5, 1, 2, 3), blend), 10);
    check_same_in_windows(text, from_csv(on_tool + rows_by_line(lines), blend), 10);
    check_same_in_windows(text, from_csv(feed + rows_by_line(lines), blend), 10);
    check_same_in_windows(
        text, from_csv(linear + "s_mm,fx_N,fy_N,fz_N\n0,5,0,0\n20,90,0,-8\n1e3,0,0,0\n", blend), 10);
    check_same_in_windows(
        text, from_csv(on_tool + "t_s,fx_N,fy_N,fz_N\n0,5,0,0\n7,90,0,-8\n20,0,0,0\n", blend), 10);
  }
  std::string commented;
  for (const char c : text) {
    commented += c;
    if (c == '\n' && commented.size() % 7 == 0)
      commented += fmt::format("(FORCE FX={})\n", commented.size() % 100);
  }
  ForceSource comments;
  check_same_in_windows(commented, comments, 10);
}

TEST_CASE("blocks that only turn the tool are the same in windows") {
  std::string text = "G21 G90 G17 G0 X0 Y0 Z5 A0 B0 C0\nG1 Z0 F600\n";
  for (int block = 1; block <= 60; ++block)
    text += fmt::format("X{:.1f}\nA{:.1f}\n", 0.7 * block, 0.4 * block);
  for (const double blend : {0.0, 0.5e-3, 2e-3, 5e-3})
    check_same_in_windows(text, from_csv(on_tool + rows_by_line(122), blend), 10);
}

TEST_CASE("a feed run of any length is split into windows if it is longer than two blends") {
  std::string text = "G21 G90 G17 G0 X0 Y0 Z0\nG1 F100\n";
  for (int block = 1; block <= 400; ++block) text += fmt::format("X{:.1f}\n", 0.1 * block);
  check_same_in_windows(text, constant(wrench(30, 0, 0), 2e-3), 80);
  check_same_in_windows(text, from_csv(on_tool + rows_by_line(300), 2e-3), 80);
}

TEST_CASE("blocks of 0.1 mm with a wrench each are the same in windows, with air above a height, too") {
  std::string text = "G21 G90 G17 G0 X0 Y0 Z5\n";
  for (int pass = 0; pass < 4; ++pass) {
    text += fmt::format("G0 X0 Y{}\nG1 Z0 F300\n", pass);
    for (int i = 1; i <= 150; ++i)
      text += fmt::format("X{:.1f} Z{:.3f} F900\n", 0.1 * i, 0.5 * std::sin(0.1 * i));
    text += "G0 Z5\n";
  }
  const int lines = static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  for (const double blend : {0.0, 0.7e-3, 2e-3, 30e-3}) {
    ForceSource source = from_csv(on_tool + rows_by_line(lines), blend);
    check_same_in_windows(text, source, 4);
    source.air_above_mm = 0.2;
    check_same_in_windows(text, source, 4);
  }
}

TEST_CASE("rules for tools, operations, lines and lengths act the same in windows") {
  std::string text = "G21 G90 G17 G0 X0 Y0 Z5\n";
  for (int cut = 0; cut < 12; ++cut) {
    text += fmt::format("T{} M6\n(CUT {})\nG0 X0 Y{}\nG1 Z-1 F300\n", cut % 3 + 1, cut % 5, cut);
    for (int i = 1; i <= 20; ++i)
      text += fmt::format("{}X{:.1f}\n", i == 4 ? fmt::format("N{} ", cut) : "", 0.4 * i);
    text += "G0 Z5\n";
  }
  for (const double blend : {0.0, 2e-3}) {
    ForceSource source;
    source.blend = blend;
    const std::string columns = "fx_N,fy_N,fz_N\n";
    int file = 0;
    for (const std::string& rows :
         {"tool," + columns + "T1,10,0,0\nT2,0,20,0\n", "op," + columns + "cut 3,0,0,30\n",
          "s_mm," + columns + "40,7,7,7\n43.3,,,\n61,8,8,8\n65,,,\n"})
      for (ForceRule& rule : read_force_csv(on_tool + rows, fmt::format("{}.csv", ++file)))
        source.rules.push_back(rule);
    source.rules.push_back(parse_force_rule("T3=-5,-5,-5"));
    const ForceSelector blocks{.blocks = {{10, 10}}};
    source.rules.push_back({"blocks", {}, blocks, ConstantForce{wrench(0, 9, 0)}});
    check_same_in_windows(text, source, 12);
  }
}

TEST_CASE("block numbers count on in the next window") {
  std::string text = "N1 G21 G90 G17 G0 X0 Y0 Z0\nN2 G1 F100 X1\n";
  for (int block = 2; block <= 100; ++block)
    text += block % 20 == 0 ? fmt::format("N{} X{}\n", block, block) : fmt::format("X{}\n", block);
  check_same_in_windows(text, from_csv(on_tool + "n,fx_N,fy_N,fz_N\n1,5,0,0\n40,90,0,0\n80,7,0,0\n", 0), 20);
}

TEST_CASE("the cover of a profile is checked over all windows") {
  const std::string text = many_runs();
  for (const std::string rows :
       {"line,fx_N,fy_N,fz_N\n1,5,0,0\n999,0,0,0\n", "line,fx_N,fy_N,fz_N\n50,5,0,0\n",
        "s_mm,fx_N,fy_N,fz_N\n0,5,0,0\n9999,0,0,0\n", "n,fx_N,fy_N,fz_N\n1,5,0,0\n",
        "line,fx_N,fy_N,fz_N\n1,5,0,0\n100,0,0,0\n"}) {
    CAPTURE(rows);
    const auto cover = [&](std::size_t least_moves) -> std::string {
      try {
        FileReader bytes = FileReader::of_bytes(text);
        ReadOptions read;
        read.dialect = "linuxcnc";
        read.tool_orientation = true;
        ProgramReader reader(bytes, "p.ngc", read, least_moves);
        ForceSource source = from_csv(on_tool + rows);
        ForceCover all(source);
        PathEnd end;
        while (reader.next()) {
          const Toolpath path = build_toolpath(reader.window(), one_frame(reader.window(), {}), end);
          all.add(reader.window(), path);
          end = path.end;
        }
        all.end_pass();
      } catch (const InputError& error) {
        return error.what();
      }
      return "covered";
    };
    CHECK(cover(3) == cover(whole_program));
    CHECK((cover(3) == "covered") == (rows.find("100,0") != std::string::npos));
  }
}
