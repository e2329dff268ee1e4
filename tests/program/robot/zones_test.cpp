// Zones of written robot programs, read from their text by a reader of the test.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "counterflex/program/overview.hpp"
#include "counterflex/program/program_reader.hpp"
#include "program/robot/edits.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

struct WrittenPoint {
  Vector3 p = Vector3::Zero();
  double zone = 0;  // mm
};

// Numbers of `text` from byte `at` on, up to a byte of another kind.
std::vector<double> numbers_from(const std::string& text, std::size_t at, std::size_t count) {
  std::vector<double> numbers;
  while (numbers.size() < count) {
    at = text.find_first_of("-.0123456789", at);
    std::size_t used = 0;
    numbers.push_back(std::stod(text.substr(at, 24), &used));
    at += used;
  }
  return numbers;
}

std::vector<std::string> lines_with(const std::string& text, const std::string& head) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (text.compare(at, head.size(), head) == 0) lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

// "MoveL [[1,2,3],...],v50,z10,t;"
std::vector<WrittenPoint> points_of_rapid(const std::string& text) {
  std::vector<WrittenPoint> points;
  for (const std::string& line : lines_with(text, "Move")) {
    const std::vector<double> p = numbers_from(line, line.find("[["), 3);
    WrittenPoint point{{p[0], p[1], p[2]}, 0};
    const std::size_t zone = line.find(',', line.find(",v50") + 1) + 1;
    if (line.compare(zone, 7, "[FALSE,") == 0)
      point.zone = numbers_from(line, zone, 1)[0];
    else if (line[zone] == 'z')
      point.zone = std::max(0.3, numbers_from(line, zone, 1)[0]);  // z0 is 0.3 mm
    points.push_back(point);
  }
  return points;
}

// "movel(p[0.1,...],v=0.1,r=0.01)"
std::vector<WrittenPoint> points_of_ur(const std::string& text) {
  std::vector<WrittenPoint> points;
  for (const std::string& line : lines_with(text, "movel")) {
    const std::vector<double> p = numbers_from(line, line.find("p["), 3);
    const std::size_t zone = line.find("r=");
    points.push_back({1e3 * Vector3(p[0], p[1], p[2]),
                      zone == std::string::npos ? 0 : 1e3 * numbers_from(line, zone, 1)[0]});
  }
  return points;
}

std::string rapid_of(const std::vector<Vector3>& targets) {
  std::string text = "MODULE job\nCONST zonedata own:=[FALSE,12,18,18,1.8,18,1.8];\nPROC main()\n";
  const char* const zones[] = {"z0", "own", "z100", "z5", "[FALSE,2,3,3,.3,3,.3]"};
  for (std::size_t i = 0; i < targets.size(); ++i)
    text += fmt::format("Move{} [[{},{},{}],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v50,{},t;\n",
                        i == 0 ? "J" : "L", targets[i].x(), targets[i].y(), targets[i].z(), zones[i % 5]);
  return text + "ENDPROC\nENDMODULE\n";
}

std::string ur_of(const std::vector<Vector3>& targets) {
  std::string text = "def job():\n";
  for (std::size_t i = 0; i < targets.size(); ++i)
    text += fmt::format("movel(p[{:.6f},{:.6f},{:.6f},0,0,0],v=0.1,r={})\n", targets[i].x() / 1e3,
                        targets[i].y() / 1e3, targets[i].z() / 1e3, i % 3 == 0 ? 0.0003 : 0.004);
  return text + "end\n";
}

// Targets at least 10 mm apart.
std::vector<Vector3> some_targets(std::mt19937& random) {
  std::uniform_real_distribution<double> step(-20, 20);
  std::vector<Vector3> targets{{0, 0, 100}};
  for (int i = 0; i < 30; ++i)
    targets.push_back(targets.back() + Vector3(10 + std::abs(step(random)), step(random), step(random)));
  for (Vector3& p : targets) p = (p * 1e3).array().round().matrix() / 1e3;
  return targets;
}

// Points at some fractions of some moves, also very near to their ends, and jumps at their starts.
std::vector<MoveEdit> some_edits(const Program& program, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<MoveEdit> edits = robot_edits(program);
  for (MoveEdit& edit : edits) {
    const Move& move = program.moves[edit.move];
    edit.end_mm += Vector3(0, 0.01, -0.005);
    if (!move.may_split || unit(random) < 0.4) continue;
    if (move.may_jump && unit(random) < 0.3)
      edit.jump = Via{move.start_mm + Vector3(unit(random) < 0.5 ? 0.02 : 0.001, 0.01, -0.005),
                      {},
                      move.orientation->start};
    for (const double u : {0.001, 0.03, 0.5, 0.98})
      if (unit(random) < 0.6)
        edit.inserted.push_back(
            {move.start_mm + u * (move.end_mm - move.start_mm), {}, move.orientation->end});
  }
  return edits;
}

struct ZoneLanguage {
  const char* file;
  std::string (*text)(const std::vector<Vector3>&);
  std::vector<WrittenPoint> (*points)(const std::string&);
};

}  // namespace

TEST_CASE("an inserted point is as far from the next point as twice the zones at both, as they are written") {
  const ZoneLanguage languages[] = {{"job.mod", rapid_of, points_of_rapid},
                                    {"job.script", ur_of, points_of_ur}};
  for (const ZoneLanguage& language : languages) {
    CAPTURE(language.file);
    std::mt19937 random(21);
    for (int run = 0; run < 20; ++run) {
      const Program program = read_program(language.text(some_targets(random)), language.file, {});
      const std::vector<MoveEdit> edits = some_edits(program, random);
      const Rewritten out = rewrite(program, edits, {});
      const std::vector<WrittenPoint> points = language.points(out.text);
      REQUIRE(points.size() == program.moves.size() + out.inserted_blocks);
      REQUIRE(out.inserted_blocks > 20);
      std::size_t at = 0;
      for (const std::size_t inserted : out.blocks_of_edit) {
        for (std::size_t k = 0; k < inserted; ++k, ++at)
          for (const std::size_t side : {at - 1, at + 1}) {
            CAPTURE(at);
            const double spacing = (points[at].p - points[side].p).norm();
            CHECK(points[at].zone > 0);
            CHECK(spacing >= 2 * points[at].zone - 1e-9);
            CHECK(spacing >= 2 * points[side].zone - 1e-9);
          }
        ++at;
      }
    }
  }
}

TEST_CASE("a window of a RAPID program does not end at a zone that the next window limits") {
  std::mt19937 random(5);
  const std::string text = rapid_of(some_targets(random));
  FileReader bytes = FileReader::of_bytes(text);
  ProgramReader reader(bytes, "job.mod", {}, 4);
  REQUIRE(reader.next());
  CHECK(reader.window().moves.size() == 31);
}

TEST_CASE("zones are counted, with the largest length that the program states") {
  const auto zones = [](const std::string& file, const std::string& text) {
    return zones_in_words(read_program(text, file, {}).zones);
  };
  const std::string first = "LIN {X 0,Y 0,Z 0,A 0,B 0,C 0} C_DIS\n", next = "LIN {X 9} C_DIS\n";
  CHECK(zones("a.src", "DEF a()\n" + first + "$APO.CDIS=2.5\n" + next +
                           "LIN {X 1} C_VEL\nLIN {X 2}\nEND\n") == "round 3 targets, largest 2.5 mm, line 4");
  CHECK(zones("a.src", "DEF a()\n$APO={CDIS 5,CORI 2}\nBAS(#CP_PARAMS,0.1)\n" + first + "END\n") ==
        "round 1 target, their length is not known");
  CHECK(zones("a.src", "DEF a()\n" + first + "$APO.CDIS=size*2\n" + next + "END\n") ==
        "round 2 targets, their length is not known");
  CHECK(zones("a.src", "DEF a()\nLIN {X 0,Y 0,Z 0,A 0,B 0,C 0}\nEND\n").empty());
  const std::string rest = ",[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";
  CHECK(zones("a.mod", "MODULE a\nPROC main()\nMoveJ [[0,0,0]" + rest + ",v50,z20,t;\nMoveL [[5,0,0]" + rest +
                           ",v50,z20,t;\nMoveL [[9,0,0]" + rest + ",v50,fine,t;\nENDPROC\nENDMODULE\n") ==
        "round 2 targets, largest 20 mm, line 3");
  CHECK(zones("a.script", "def a():\n movel(p[0,0,0,0,0,0])\n movel(p[0,0,1,0,0,0],r=0.002)\nend\n") ==
        "round 1 target, largest 2 mm, line 3");
}
