#include <doctest/doctest.h>

#include "counterflex/geometry/types.hpp"
#include "program/reading.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string frames_start = "G21 G90 G17 G54 F100\nG0 X10. Y20. Z5.\n";

const ProgramFrame& frame_of_last(const Program& program) {
  return program.frames[program.moves.back().frame];
}

const std::string siemens_start = "G71 G90 G17 G54 F100\nG0 X10 Y20 Z5\n";

/// End of the last move, in the coordinates of the work offset (mm).
Vector3 end_in_offset(const Program& program) {
  return in_offset(frame_of_last(program)) * program.moves.back().end_mm;
}

bool followed(const Program& program) {
  const Move& last = program.moves.back();
  return all_known(last.known_end) && !last.fixed[0] && !last.fixed[1] && !last.fixed[2];
}

}  // namespace

TEST_CASE("G52 shifts the coordinates of the offset by plain numbers, axis by axis, and ends with zeros") {
  for (const char* const dialect : {"fanuc", "haas", "linuxcnc", "mach3"}) {
    CAPTURE(dialect);
    const Program shifted = read(frames_start + "G52 X5. Y1.\nG52 Y2.\nG1 X1.\n", dialect);
    CHECK(followed(shifted));
    CHECK(shifted.left_alone.empty());
    CHECK((end_in_offset(shifted) - Vector3(6, 20, 5)).norm() < 1e-12);
    CHECK((shifted.moves.back().start_mm - Vector3(5, 18, 5)).norm() < 1e-12);
    CHECK(frame_of_last(shifted).work_offset == "G54");
    const Program ended = read(frames_start + "G52 X5. Y1.\nG1 X1.\nG52 X0. Y0. Z0.\nG1 X1.\n", dialect);
    CHECK(followed(ended));
    CHECK((end_in_offset(ended) - Vector3(1, 20, 5)).norm() < 1e-12);
  }
}

TEST_CASE(
    "G92 shifts the coordinates so that its words are the tool's position; its words are shifted with the "
    "correction"
    "corrections") {
  for (const char* const dialect : {"fanuc", "linuxcnc", "grbl"}) {
    CAPTURE(dialect);
    const Program program = read(frames_start + "G1 X12.3456\nG92 X0. Y1.\nG1 X1.\n", dialect);
    CHECK(followed(program));
    CHECK((end_in_offset(program) - Vector3(13.3456, 20, 5)).norm() < 1e-12);
    REQUIRE(program.moves.size() == 4);
    const Move& set = program.moves[2];
    CHECK(set.handling == Handling::held);
    CHECK(set.start_mm == set.end_mm);
    REQUIRE((set.words[0] && set.words[1]));
    CHECK_FALSE(set.words[2]);
    CHECK(set.words[0]->decimals == 9);
    const Program ended = read(frames_start + "G92 X0. Y1.\nG1 X1.\nG92.1\nG1 X1.\n", "linuxcnc");
    CHECK(followed(ended));
    CHECK((end_in_offset(ended) - Vector3(1, 20, 5)).norm() < 1e-12);
  }
}

TEST_CASE("G92 before any move gives the position set by the operator") {
  const Program program = read("G21 G90\nG92 X5. Y8.\nG0 Z2.\nG1 X1. F100\n");
  CHECK(program.moves.size() == 2);
  CHECK(followed(program));
  CHECK((program.moves[0].start_mm.head<2>() - Vector3(5, 8, 0).head<2>()).norm() == 0);
  CHECK(frame_of_last(program).origin_mm.isZero(0));
}

TEST_CASE("behind G92 the first move gets no word for an axis that stays at the position set") {
  const std::string text = "G21 G90\nG92 X10. Y0. Z0.\nG0 X10. Y5.\nG1 X20. F100\n";
  const Program program = read(text);
  CHECK(rewrite(program, edits_to_original(program), {}).text == text);
  std::vector<MoveEdit> edits = edits_to_original(program);
  for (MoveEdit& edit : edits) edit.end_mm.z() += 0.25;
  CHECK(rewrite(program, edits, {}).text == "G21 G90\nG92 X10. Y0. Z0.\nG0 X10. Y5. Z0.250\nG1 X20. F100\n");
}

TEST_CASE("G92 of zeros needs no unit") {
  CHECK(followed(read("G92 X0 Y0 Z0\nG21 G90\nG0 X1. Y2. Z3.\nG1 X2. F100\n", "grbl")));
}

TEST_CASE("in LinuxCNC and Mach3 G52 replaces G92, on other controls it is added to G92") {
  const std::string text = frames_start + "G92 X0. Y0.\nG52 X3. Y4.\nG1 X1. Y1.\n";
  for (const char* const dialect : {"linuxcnc", "mach3"})
    CHECK((end_in_offset(read(text, dialect)) - Vector3(4, 5, 5)).norm() < 1e-12);
  CHECK((end_in_offset(read(text, "fanuc")) - Vector3(14, 25, 5)).norm() < 1e-12);
}

TEST_CASE(
    "G68 rotates the coordinates about its centre; X and Y are unknown until they are programmed, and after "
    "G69"
    "it") {
  const Program program = read(frames_start + "G68 X10. Y0. R90.\nG1 X20. Y0.\nG1 X30.\n", "fanuc");
  CHECK(followed(program));
  CHECK((end_in_offset(program) - Vector3(10, 20, 5)).norm() < 1e-12);
  CHECK(program.moves[1].known_start == std::array<bool, 3>{false, false, true});
  CHECK(program.moves[2].known_start == std::array<bool, 3>{true, true, true});
  const Program ended = read(frames_start + "G68 X10. Y0. R90.\nG1 X20. Y0.\nG69\nG1 X1. Y2.\n", "haas");
  CHECK(followed(ended));
  CHECK((end_in_offset(ended) - Vector3(1, 2, 5)).norm() < 1e-12);
}

TEST_CASE(
    "conditions, variables, unknown positions and rotations without a plain angle give no frame"
    "centre") {
  for (const char* const block :
       {"G52 X[1]", "G92 X#1", "G68 R30.", "G68 X0. Y0. Z0. R30.", "G18 G68 X0. Y0. R30.", "G91 G52 X1.",
        "G53 Z0.\nG92 Z0.", "G68 X0. Y0. R30.\nG52 X1.", "IF[#1EQ1]THEN #2=1\nG52 X1.\nG55",
        "G16\nG52 X1."}) {
    CAPTURE(block);
    const Program program = read(frames_start + block + "\nX1. Y1.\n", "fanuc");
    CHECK_FALSE(followed(program));
    CHECK_FALSE(program.left_alone.empty());
  }
  const Program in_body =
      read(frames_start + "o1 if [#1 GT 2]\nG52 X1.\no1 endif\nX1. Y1. Z1.\n", "linuxcnc");
  CHECK_FALSE(followed(in_body));
}

TEST_CASE(
    "TRANS, ATRANS, ROT and AROT of a Sinumerik shift and rotate about Z by plain numbers, and end each other"
    "other") {
  const auto end_of = [](const std::string& blocks) {
    const Program program = read(siemens_start + blocks, "siemens");
    CAPTURE(blocks);
    CHECK(followed(program));
    CHECK(program.left_alone.empty());
    return end_in_offset(program);
  };
  CHECK((end_of("TRANS X5 Y=1.5\nG1 X1\n") - Vector3(6, 20, 5)).norm() < 1e-12);
  CHECK((end_of("TRANS X5\nATRANS X1 Z2\nG1 X1 Z0\n") - Vector3(7, 20, 2)).norm() < 1e-12);
  CHECK((end_of("TRANS X5\nTRANS Y1\nG1 X1 Y1\n") - Vector3(1, 2, 5)).norm() < 1e-12);
  CHECK((end_of("TRANS X5\nTRANS\nG1 X1\n") - Vector3(1, 20, 5)).norm() < 1e-12);
  CHECK((end_of("TRANS X5\nAROT Z90\nG1 X1 Y0\n") - Vector3(5, 1, 5)).norm() < 1e-12);
  CHECK((end_of("ROT RPL=90\nATRANS X5\nG1 X1 Y0\n") - Vector3(0, 6, 5)).norm() < 1e-12);
  CHECK((end_of("TRANS X5\nROT RPL=90\nG1 X1 Y0\n") - Vector3(0, 1, 5)).norm() < 1e-12);
  CHECK((end_of("TRANS X5\nAROT RPL=30\nROT\nG1 X1 Y0\n") - Vector3(1, 0, 5)).norm() < 1e-12);
}

TEST_CASE("a shift of rotated coordinates does not move the tool") {
  const Program program = read(siemens_start + "AROT Z30\nG1 X10 Y0\nATRANS X5 Y2\nG1 Z1\n", "siemens");
  CHECK(followed(program));
  const Move &before = program.moves[1], &last = program.moves.back();
  CHECK((in_offset(frame_of_last(program)) * last.start_mm -
         in_offset(program.frames[before.frame]) * before.end_mm)
            .norm() < 1e-12);
  CHECK((last.end_mm - Vector3(5, -2, 1)).norm() < 1e-12);
}

TEST_CASE("after a Sinumerik frame that is not followed, moves are unknown until the next TRANS") {
  for (const std::string frame :
       {"TRANS X=R1", "ROT X10", "MIRROR X0", "TRANS X5 MIRROR X0", "TRANS X=IC(5)"}) {
    CAPTURE(frame);
    CHECK_FALSE(followed(read(siemens_start + frame + "\nG1 X1 Y1 Z1\n", "siemens")));
    CHECK_FALSE(followed(read(siemens_start + frame + "\nATRANS X1\nG1 X1 Y1 Z1\n", "siemens")));
    CHECK(followed(read(siemens_start + frame + "\nTRANS X1\nG1 X1 Y1 Z1\n", "siemens")));
  }
}

TEST_CASE(
    "G10 L2 sets the position of an offset, axis by axis, and positions in it are unknown until they are "
    "programmed") {
  const Program program = read(frames_start + "G10 L2 P1 X7. Z-3.\nG1 Y1.\nG0 X2. Z4.\n");
  CHECK(followed(program));
  CHECK(program.left_alone.empty());
  const ProgramFrame& frame = frame_of_last(program);
  CHECK(frame.work_offset == "G54");
  CHECK(frame.set_mm == std::array<std::optional<double>, 3>{7.0, std::nullopt, -3.0});
  CHECK(program.moves[1].known_start == std::array<bool, 3>{false, true, false});
  CHECK(is_set(frame));
  const Program other = read(frames_start + "G10 L2 P2 X7.\nG1 X1.\nG55 G0 X2. Y0 Z4.\n");
  CHECK_FALSE(is_set(other.frames[other.moves[1].frame]));
  CHECK(is_set(frame_of_last(other)));
}

TEST_CASE(
    "G10 L20 moves the zero of the active offset to the tool's position, and its words are shifted with the "
    "correction") {
  const Program program = read(frames_start + "G10 L20 P1 X0\nG1 X5.\n");
  CHECK(followed(program));
  CHECK((end_in_offset(program) - Vector3(15, 20, 5)).norm() < 1e-12);
  REQUIRE(program.moves.size() == 3);
  CHECK(program.moves[1].handling == Handling::held);
  CHECK(program.moves[1].words[0]);
  const Program first = read("G21 G90 G10 L20 P0 X0 Y0 Z5.\nG1 X5. F100\n");
  CHECK(followed(first));
  CHECK((end_in_offset(first) - Vector3(5, 0, 5)).norm() < 1e-12);
}

TEST_CASE(
    "G10 that rotates an offset, is incremental, or sets another offset by the tool's position is not "
    "followed") {
  for (const char* block : {"G10 L2 P1 X1. R30.", "G10 L20 P2 X0", "/G10 L2 P1 X1.", "G10 L2 P1 X#1"}) {
    CAPTURE(block);
    CHECK_FALSE(
        read(frames_start + block + "\nG90 G55 G1 X1. Y1. Z1.\nG54 X1. Y1. Z1.\n").left_alone.empty());
  }
  for (const char* block : {"G10 L2 P0 X1.", "G91 G10 L2 P1 X1."})
    CHECK_FALSE(read(frames_start + block + "\nG90 G1 X1. Y1. Z1.\n", "fanuc").left_alone.empty());
}

TEST_CASE(
    "in LinuxCNC and GRBL the words of G10 have the same effect under G91, in LinuxCNC also those of G52") {
  for (const std::string dialect : {"linuxcnc", "grbl"}) {
    CAPTURE(dialect);
    for (const char* block : {"G10 L2 P1 X3.\n", "G10 L20 P1 Y-2.23\n", "G52 X-2.\n"}) {
      CAPTURE(block);
      if (dialect == "grbl" && block[1] == '5') continue;
      const std::string end = "G90 G1 X5. Y2. Z7.\n";
      const Program absolute = read(frames_start + block + end, dialect),
                    relative = read(frames_start + "G91\n" + block + end, dialect);
      CHECK(followed(relative));
      CHECK(end_in_offset(relative) == end_in_offset(absolute));
      CHECK(frame_of_last(relative) == frame_of_last(absolute));
    }
  }
}

TEST_CASE("G92 of shop controls ends G52 of the axes that it names") {
  for (const char* dialect : {"fanuc", "haas"}) {
    const Program program = read(
        frames_start + "G52 X100. Y50. Z0.\nX20. Y0.\nG92 X0.\nG52 X0. Y0. Z0.\nX200. Y0. Z1.\n", dialect);
    CHECK(followed(program));
    CHECK((end_in_offset(program) - Vector3(320, 0, 1)).norm() < 1e-9);
  }
}

TEST_CASE("G10 L20 of an offset that does not act is unknown only where this offset is selected") {
  const std::string text = frames_start + "G10 L20 P2 X5. Y5. Z5.\nG1 X5. Y2. Z7.\n";
  for (const char* dialect : {"linuxcnc", "grbl"}) {
    CAPTURE(dialect);
    CHECK(followed(read(text, dialect)));
    CHECK_FALSE(followed(read(text + "G55 G1 X1. Y1. Z1.\n", dialect)));
    CHECK(followed(read(text + "G55 G1 X1. Y1. Z1.\nG54 X1. Y1. Z1.\n", dialect)));
  }
}

TEST_CASE("a shift that ends where states are unknown ends, and one that a condition sets stays in doubt") {
  const std::string shift = frames_start + "G52 X500. Y0. Z0.\nG0 X0. Y0. Z0.\n";
  const std::string cut = "G90 G0 X0. Y0. Z0.\nG1 X40.\n";
  const auto end = [&](const std::string& lines, const char* dialect) {
    const Program program = read(lines + cut, dialect);
    REQUIRE(followed(program));
    return end_in_offset(program).x();
  };
  CHECK(end(shift + "/G1 Z0.\nG52 X0. Y0. Z0.\n", "fanuc") == doctest::Approx(40));
  CHECK(end(shift + "G91 G28 Z0\nG52 X0. Y0. Z0.\n", "linuxcnc") == doctest::Approx(40));
  CHECK(end(shift + "G55\nG52 X0. Y0. Z0.\n", "fanuc") == doctest::Approx(40));
  CHECK(end(shift + "G52 X[#1] Y0.\nG52 X0. Y0. Z0.\n", "linuxcnc") == doctest::Approx(40));
  const std::string set = frames_start + "G92 X500. Y0. Z0.\n";
  CHECK(end(set + "/G1 Z0.\nG92.1\n", "linuxcnc") == doctest::Approx(40));
  const std::string condition = "o1 if [#1 EQ 0]\nG92.1\no1 endif\n";
  CHECK_FALSE(followed(read(set + condition + cut, "linuxcnc")));
  CHECK_FALSE(followed(read(set + condition + "G54\n" + cut, "linuxcnc")));  // ends no G92
  CHECK(end(set + condition + "G92.1\nG54\n", "linuxcnc") == doctest::Approx(40));
  for (const char* const line :
       {"/G68 X0. Y0. R30.\n", "/G52 X500.\n", "/G52 X500.\nG54\n", "/G68 X0. Y0. R30.\nG54\n"})
    CHECK_FALSE(followed(read(frames_start + line + cut, "fanuc")));
  CHECK(followed(read(frames_start + "/G68 X0. Y0. R30.\nG69\nG54\n" + cut, "fanuc")));
}

TEST_CASE("behind variables and parameters of the control no offset is known") {
  for (const char* const line :
       {"#5241=200.\n", "#5221=#5221+200.\n", "#2501=200.\n", "#5201=1.\n", "#[#1]=200.\n", "#2001=100.\n",
        "G10 L#5 P1 X200.\n", "G10 L50\nN1221 P1 R200.\nG11\n", "IF [#1 EQ 2] THEN #5221=5.\n"}) {
    CAPTURE(line);
    CHECK_FALSE(followed(read(frames_start + line + "G54\nG0 X0. Y0. Z0.\nG1 X40.\n", "fanuc")));
  }
  for (const char* const line : {"#500=2.\n", "#1100=1.\n", "#3006=1 (LOOK)\n", "G10 L50\nN3202 R16.\nG11\n"})
    CHECK(followed(read(frames_start + line + "G54\nG0 X0. Y0. Z0.\nG1 X40.\n", "fanuc")));
  CHECK(followed(read(frames_start + "#5160=2.\n#<depth>=3\nG0 X0. Y0. Z0.\nG1 X40.\n", "linuxcnc")));
  CHECK_FALSE(followed(read(frames_start + "#5221=2.\nG0 X0. Y0. Z0.\nG1 X40.\n", "linuxcnc")));
}
