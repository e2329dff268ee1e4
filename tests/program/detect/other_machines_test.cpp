#include <doctest/doctest.h>

#include "program/reading.hpp"
#include "support/text.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

std::string refusal(const std::string& text, const std::string& dialect = "auto") {
  return diagnostic_of([&] { read(text, dialect); });
}

}  // namespace

TEST_CASE("programs of machines that do not mill are refused with the kind of the machine") {
  std::string cuts;
  for (int i = 0; i < 4; ++i) cuts += fmt::format("G0 X{} Y0\nM3 S80\nG1 Y5 F100\nM5\n", i);
  const std::pair<std::string, const char*> programs[] = {
      {"%\nO358\nN01G50S0600\nG00T0202\nG96S450M03\nX86.\nZ0.25\nG01X118F0.3\n",
       "a lathe program (G96 and no Y)"},
      {"G21\nT0101\nG0 X50 Z2\nG1 Z-20 F0.2\n", "a lathe program (T with four digits and no Y)"},
      {"G50 S2000\nT1\nG0 X50 Z2\nG1 Z-20 F0.2\n", "a lathe program (G50 S and no Y)"},
      {"%1\nN10 T26 M03\nG0 X54 Z100\nG3 X58 Z90 I-2 K-10 F100\n",
       "a lathe program (arcs with K, no G18 and no Y)"},
      {"G21\nG90\n" + cuts, "a laser or plasma program (M3 and M5 for each cut, and no Z)"},
      {"G21\nM3 S700 ; Turn laser on\nG1 X1 Y2 F100\n", "a laser program (named in comments)"},
      {"$I\nM3 S700 ; Turn laser on\nG1 X1 Y2 Z-0.1 F100\n", "a laser program (named in comments)"},
      {"(PLASMA)\nG21\nG1 X1 Y2 F100\n", "a plasma program (named in comments)"},
      {"M104 S200\nG28\nG1 X10 Y10 Z0.2 E1.5 F900\n",
       "a program of a 3D printer (it heats, and E feeds the filament)"},
      {"$OKUMA.SSB%\nG0 G90 G17 G21\n", "an Okuma program ($...% at its beginning)"},
      {"%PM\nN9001\nG0 X1\n", "a Philips program (%PM and N9... at its beginning)"},
  };
  for (const auto& program : programs) {
    const auto& [text, machine] = program;
    CAPTURE(program.first);
    CHECK(refusal(text).starts_with("p.ngc:1:1: error: this is " + std::string(machine) +
                                    ", which is not supported; "));
    CHECK(refusal(text, "fanuc") == refusal(text));
  }
}

TEST_CASE("milling programs with some of these signs are read") {
  for (const char* text : {
           "G21\nT1 M6\nG96 S100 M3\nG0 X1 Y1 Z5\nG1 Z-1 F100\n",  // Y
           "G21\nG0 X1 Z5\nG1 Z-1 F100\nX5\n",                     // no sign of a lathe
           "G21 G18\nG0 X0 Z0\nG2 X10 Z0 I5 K0 F100\n",            // G18
           "G21\n(NO LASER PROBE)\nG0 X1 Y1 Z5\nM3 S80\nG1 Z-1 F100\nM5\n",
           "G21\nM3 S80\nG0 X1 Y1\nG1 X2 F100\nM5\nG0 X5\nM3\nG1 X6\nM5\n",  // a spindle that is switched
                                                                             // twice
           "G21\n(LASERED PLATE)\nG1 X1 Y2 F100\n",
       })
    CHECK(refusal(text) == "none");
}
