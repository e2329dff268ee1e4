// Programs that turn the tool, read and written window by window.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "counterflex/program/program_reader.hpp"
#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

std::string long_krl() {
  std::string text = "DEF job()\n;LEVEL 1\n$BASE=BASE_DATA[2]\nPTP {X 0,Y 0,Z 0,A 0,B 0,C 0}\n$VEL.CP=0.1\n";
  for (int i = 0; i < 5000; ++i) {
    const double x = 0.1 * i;
    text += fmt::format("LIN {{X {:.3f},Y {:.2f},Z 0,A {:.4f},B 0,C 0}} C_DIS\n", x, x / 2, 0.01 * i);
    if (i % 7 == 0) text += "LIN {Z 1} C_DIS ; up\n";
    if (i % 50 == 0)
      text += fmt::format("CIRC {{X {:.3f},Y {:.3f},Z 1}},{{X {:.3f},Y {:.2f},Z 1}} C_DIS\n", x + 0.5,
                          x / 2 + 0.5, x + 1, x / 2);
    if (i % 900 == 0) text += fmt::format(";LEVEL {}\nPTP {{A1 0}}\nPTP {{X 0,Y 0,Z 0,A 0,B 0,C 0}}\n", i);
  }
  return text + "END\n";
}

std::string long_rapid() {
  std::string text =
      "MODULE job\nVAR speeddata cut:=[20,500,5000,1000];\nPROC main()\n! LEVEL 1\n"
      "MoveJ [[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,t\\WObj:=w;\n";
  for (int i = 1; i < 5000; ++i) {
    const double x = 0.1 * i, angle = 1e-4 * i;
    const auto target = [&](double ahead, double up) {
      return fmt::format("[[{:.3f},{:.2f},{}],[{:.7f},0,0,{:.7f}],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]",
                         x + ahead, x / 2, up, std::cos(angle), std::sin(angle));
    };
    text += fmt::format("MoveL {},cut,{},t\\WObj:=w; ! {}\n", target(0, 0), i % 60 == 0 ? "fine" : "z1", i);
    if (i % 50 == 0) text += fmt::format("MoveC {},{},cut,z1,t\\WObj:=w;\n", target(0.5, 0.5), target(1, 0));
    if (i % 900 == 0) text += "ENDPROC\nPROC next()\nTPWrite \"next\";\n";
    if (i % 900 == 400) text += "report;\n";
  }
  return text + "ENDPROC\nPROC report()\nTPWrite \"here\";\nENDPROC\nENDMODULE\n";
}

std::string long_gcode() {
  std::string text = "G21 G90 G0 X0 Y0 Z0 A0 B0 C0\nF1000\n";
  for (int i = 0; i < 5000; ++i) text += fmt::format("G1 X{:.3f} Y1. A{:.4f} B0.5\n", 0.1 * i, 0.01 * i);
  return text + "M2\n";
}

/// Every known end shifted and turned.
std::vector<MoveEdit> edits_of(const Program& program) {
  std::vector<MoveEdit> edits;
  for (std::size_t m = 0; m < program.moves.size(); ++m) {
    const Move& move = program.moves[m];
    if (!all_known(move.known_end) || !move.orientation) continue;
    MoveEdit edit{.move = m, .end_mm = move.end_mm + Vector3(0.125, -0.0625, 0.5)};
    edit.orientation = move.orientation->end;
    (*edit.orientation)[0] += 0.03125;
    if (move.arc) edit.centre_mm = move.arc->centre_mm + Vector3(0.125, -0.0625, 0.5);
    if (move.may_split && !move.arc)
      edit.inserted = {{0.5 * (move.start_mm + move.end_mm), {}, numbers_at(*move.orientation, 0.5)}};
    edits.push_back(edit);
  }
  return edits;
}

std::string written_in_windows(const std::string& text, const ReadOptions& options, int& windows) {
  FileReader bytes = FileReader::of_bytes(text);
  ProgramReader reader(bytes, "job", options, 300);
  Rewriter rewriter({.header = {"COUNTERFLEX 1"}});
  std::string out;
  while (reader.next()) {
    out += rewriter.write(reader.window(), edits_of(reader.window())).text;
    ++windows;
  }
  return out;
}

}  // namespace

TEST_CASE("a program that turns the tool is written the same in windows and as a whole") {
  const std::pair<std::string, ReadOptions> programs[] = {
      {long_krl(), {}},
      {long_rapid(), {}},
      {long_gcode(), {.dialect = "linuxcnc", .tool_orientation = true}}};
  for (const auto& [text, options] : programs) {
    const Program whole = read_program(text, "job", options);
    CAPTURE(whole.dialect);
    const std::string expected = rewrite(whole, edits_of(whole), {.header = {"COUNTERFLEX 1"}}).text;
    int windows = 0;
    CHECK(written_in_windows(text, options, windows) == expected);
    CHECK(windows > 3);
    CHECK(expected != text);
  }
}
