// Yaskawa jobs divided into parts that a main job calls.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "counterflex/program/parts.hpp"
#include "program/robot/yaskawa/yaskawa.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// A position of these tests, with or without its name.
std::string place(int x, const std::string& name = "") {
  return (name.empty() ? "" : name + "=") + std::to_string(x) + ".000,0.000,0.000,180.0000,0.0000,0.0000\n";
}

const std::string pulses = "C00000=390876,202089,35618,0,-117424,182917\n";
const std::string user_1 = "///USER 1\n///TOOL 2\n///POSTYPE USER\n///RECTAN\n///RCONF 1,0,0,0,0,0\n";

/// A job with home in pulses, three frames, a position of two steps, a variable, and steps before and behind
/// the linear ones.
const std::string begin_of_job = "/JOB\n//NAME PART\n//POS\n///NPOS ";
const std::string positions = "///USER 1\n///TOOL 2\n///POSTYPE PULSE\n///PULSE\n" + pulses +
                              "///POSTYPE USER\n///RECTAN\n///RCONF 1,0,0,0,0,0\n" + place(1, "C00001") +
                              place(2, "C00002") + "///RCONF 0,0,0,0,0,0\n" + place(3, "C00003") +
                              "///USER 3\n///POSTYPE BASE\n///RCONF 1,0,0,0,0,0\n" + place(4, "C00004") +
                              place(100, "P00100") + place(101, "P00101");
const std::string instructions_begin =
    "//INST\n///DATE 2020/11/19 13:27\n///COMM BY HAND\n///ATTR SC,RW\n///GROUP1 RB1\n";
const std::string header = "' COUNTERFLEX 1 TEST\n";
const std::string statements_begin = "MOVJ C00000 VJ=50.00\nMOVJ C00001 VJ=25.00\nSET LI000 3\n";
const std::string first_part = "MOVL C00002 V=50.0\n'side\nDOUT OT#(1) ON\nMOVL C00003 V=50.0 PL=1\n";
const std::string second_part = "MOVJ C00001 VJ=25.00\nMOVL P100 V=50.0\nMOVL C00004 V=50.0 'end\n";
const std::string statements_end = "DOUT OT#(1) OFF\nMOVJ C00000 VJ=50.00\nEND\n";

std::string whole_job() {
  return begin_of_job + "5,0,0,2,0,0\n" + positions + "//ARGINFO\n///ARGTYPE B,,,,,,,\n" +
         instructions_begin + "///LVARS 0,1,0,0,0,0,0,0\nNOP\n" + header + statements_begin + first_part +
         second_part + statements_end;
}

std::vector<ProgramPart> parts_of(const std::string& text, std::size_t most) {
  return divide_program("part.jbi", "yaskawa", text, most);
}

std::string problem_of(const std::string& before, const std::string& between, const std::string& behind = "",
                       std::size_t most = 100) {
  const std::string text =
      job_of(jbi_positions_text, before + "MOVL C00001 V=10\n" + between + "MOVL C00002 V=10\n" + behind);
  return diagnostic_of([&] { parts_of(text, most); });
}

/// What a move goes to, in its frame and with its tool.
std::string target_of(const Program& program, const Move& move) {
  const Vector3& p = move.end_mm;
  const auto& angles = move.orientation->end;
  return fmt::format("{} {} {}: {} {} {}, {} {} {} at {}", static_cast<int>(move.motion),
                     program.frames[move.frame].work_offset, move.tool, p.x(), p.y(), p.z(), angles[0],
                     angles[1], angles[2], move.feed_mm_min);
}

std::vector<std::string> targets_of(const std::string& text) {
  const Program program = read_job(text);
  std::vector<std::string> targets;
  for (const Move& move : program.moves)
    if (move.orientation) targets.push_back(target_of(program, move));
  return targets;
}

}  // namespace

TEST_CASE("a Yaskawa job is divided into jobs that have their own positions and what holds for these") {
  const std::vector<ProgramPart> parts = parts_of(whole_job(), 3);
  REQUIRE(parts.size() == 3);
  CHECK(parts[0].name == "PART");
  CHECK(parts[0].text == begin_of_job + "2,0,0,2,0,0\n///USER 1\n///TOOL 2\n///POSTYPE PULSE\n///PULSE\n" +
                             pulses + "///POSTYPE USER\n///RECTAN\n///RCONF 1,0,0,0,0,0\n" +
                             place(1, "C00001") + "///USER 3\n///POSTYPE BASE\n" + place(100, "P00100") +
                             place(101, "P00101") + "//ARGINFO\n///ARGTYPE B,,,,,,,\n" + instructions_begin +
                             "///LVARS 0,1,0,0,0,0,0,0\nNOP\n" + header + statements_begin +
                             "CALL JOB:PART_1\nCALL JOB:PART_2\n" + statements_end);
  CHECK(parts[1].name == "PART_1");
  CHECK(parts[1].text == "/JOB\n//NAME PART_1\n//POS\n///NPOS 2,0,0,0,0,0\n" + user_1 + place(2, "C00000") +
                             "///RCONF 0,0,0,0,0,0\n" + place(3, "C00001") + instructions_begin + "NOP\n" +
                             header +
                             "MOVL C00000 V=50.0\n'side\nDOUT OT#(1) ON\nMOVL C00001 V=50.0 PL=1\nEND\n");
  CHECK(parts[2].name == "PART_2");
  CHECK(parts[2].text == "/JOB\n//NAME PART_2\n//POS\n///NPOS 2,0,0,1,0,0\n" + user_1 + place(1, "C00000") +
                             "///USER 3\n///POSTYPE BASE\n" + place(4, "C00001") + place(100, "P00100") +
                             instructions_begin + "NOP\n" + header +
                             "MOVJ C00000 VJ=25.00\nMOVL P100 V=50.0\nMOVL C00001 V=50.0 'end\nEND\n");
}

TEST_CASE("a part of a Yaskawa job has the line ends of the job") {
  std::string text = whole_job(), ended;
  for (const char c : text) ended += c == '\n' ? "\r\n" : std::string(1, c);
  for (const ProgramPart& part : parts_of(ended, 2)) {
    CHECK(std::ranges::count(part.text, '\n') == std::ranges::count(part.text, '\r'));
    CHECK(part.text.ends_with("END\r\n"));
  }
}

TEST_CASE("the parts of a Yaskawa job move to the targets of the job") {
  std::mt19937 random(21);
  const auto any = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (int run = 0; run < 20; ++run) {
    CAPTURE(run);
    std::string list, steps = "MOVL C00000 V=9.0\n";
    constexpr int count = 12;
    for (int i = 0; i < count; ++i) {
      list += fmt::format("///USER {}\n///TOOL {}\n///POSTYPE {}\n///RECTAN\n///RCONF {},0,0,0,0,0\n", any(3),
                          any(3), any(2) == 0 ? "USER" : "BASE", any(2));
      list += fmt::format("C{:05}={},{},{},{},0.0,10.0\n", i, any(100), any(100), any(100), any(90));
    }
    for (int i = 0; i < 25; ++i)
      steps += any(4) == 0 ? fmt::format("MOVJ C{:05} VJ=9.0\n", any(count))
                           : fmt::format("MOVL C{:05} V={}.0\n", any(count), 1 + any(9));
    steps += "MOVL C00001 V=9.0\n";
    const std::string text = job_of(list, steps, count);
    CAPTURE(text);
    const std::size_t most = 1 + static_cast<std::size_t>(any(10));
    const std::vector<ProgramPart> parts = parts_of(text, most);
    std::vector<std::string> targets;
    for (std::size_t k = 1; k < parts.size(); ++k) {
      const std::vector<std::string> own = targets_of(parts[k].text);
      CHECK(own.size() <= most);
      targets.insert(targets.end(), own.begin(), own.end());
    }
    CHECK(targets == targets_of(text));
    CHECK(targets.size() == 27);
  }
}

TEST_CASE("a Yaskawa job whose statements depend on the main job is not divided") {
  const std::string head = "part.jbi:22:1: error: the program cannot be divided into parts: ";
  const std::string tail = "; divide it where it was posted, or give --max-points a larger number";
  CHECK(problem_of("", "*AGAIN\n") ==
        head + "'*AGAIN' is a label, to which other statements may jump" + tail);
  CHECK(problem_of("", "JUMP *AGAIN IF B000=1\n") == head + "'JUMP *AGAIN IF B000=1' jumps" + tail);
  CHECK(problem_of("", "RET\n") == head + "'RET' jumps" + tail);
  CHECK(problem_of("", "SET LB000 1\n") == head + "'LB000' is a local variable of the main job" + tail);
  CHECK(problem_of("", "WAIT IN#(LI003)=ON\n") ==
        head + "'LI003' is a local variable of the main job" + tail);
  CHECK(problem_of("", "MOVL LP[I000] V=10\n") == head + "'LP' is a local variable of the main job" + tail);
  CHECK(problem_of("", "GETARG B000 IARG#(1)\n") ==
        head + "'GETARG B000 IARG#(1)' needs the arguments of the main job" + tail);
  CHECK(problem_of("", "SFTON P000\n") == head + "'SFTON P000' may act in one job only" + tail);
  CHECK(problem_of("", "MOVL C00003\n") ==
        head + "'MOVL C00003' has no speed of its own, and SPEED may act in one job only" + tail);
  CHECK(problem_of("", "REFP 1 C00009\n") ==
        head + "'REFP 1 C00009' needs a position that has no values above //INST" + tail);
  CHECK(problem_of("", "ENDIF\n") == head + "'ENDIF' belongs to a line before the first linear move" + tail);
  CHECK(problem_of("", "IFTHENEXP B000=1\n", "ENDIF\n") ==
        head + "'IFTHENEXP B000=1' ends behind the last linear move" + tail);
  CHECK(problem_of("", "CALL JOB:PART_1\n") ==
        head + "'CALL JOB:PART_1' needs a job that has the name of a part" + tail);
  CHECK(problem_of("DOUT OT#(1) ON\n", "MOVL C00003 V=10\n", "MOVJ C00000\n").find(":25:1: error: ") !=
        std::string::npos);
  CHECK(problem_of("SFTON P000\n", "").find(":21:1: error: ") != std::string::npos);
}

TEST_CASE("statements that act in the whole control, and those around the parts, may be what they are") {
  for (const char* statement :
       {"SET B000 1\n", "MSG \"LB000 of LP001\"\n", "CALL JOB:LB001\n", "'LB000\n", "WAIT IN#(1)=ON\n",
        "SPEED V=10\n", "REFP 1 C00003\n", "IMOV P000 V=10 RF\n", "MOVL P00100 V=I000\n",
        "IFTHENEXP B000=1\nMOVL C00003 V=10\nELSE\nDOUT OT#(1) ON\nENDIF\n", "MOVJ C00000 VJ=50\n"}) {
    CAPTURE(statement);
    CHECK(problem_of("", statement) == "none");
  }
  CHECK(problem_of("*TOP\nSFTON P000\nSFTOF\nMOVJ LP000\n", "", "SET LB000 1\nJUMP *TOP\n") == "none");
  CHECK(problem_of("IF ( IN#(1)=ON ) THEN\n", "", "ENDIF\n") == "none");
}

TEST_CASE("a circle and a condition of a Yaskawa job stay in one part") {
  const std::string circle =
      "MOVC C00002 V=10\nDOUT OT#(1) ON\nMOVC C00003 V=10\n'through\nMOVC C00001 V=10\n";
  const std::string text =
      job_of(jbi_positions_text, "MOVL C00001 V=10\nMOVL C00002 V=10\n" + circle + "MOVL C00003 V=10\n");
  const std::vector<ProgramPart> parts = parts_of(text, 4);
  REQUIRE(parts.size() == 3);
  CHECK(instructions_in(parts[1].text) == "MOVL C00000 V=10\nMOVL C00001 V=10\n");
  CHECK(instructions_in(parts[2].text).starts_with("MOVC C00001 V=10\nDOUT OT#(1) ON\nMOVC"));
  const std::string late =
      ": error: a part of at most 2 points cannot end before this statement; give "
      "--max-points a larger number";
  CHECK(diagnostic_of([&] { parts_of(text, 2); }) == "part.jbi:27:1" + late);
  CHECK(problem_of("", "WHILEEXP B000=1\nMOVL C00001 V=10\nMOVL C00002 V=10\nMOVL C00003 V=10\nENDWHILE\n",
                   "", 2) == "part.jbi:25:1" + late);
}

TEST_CASE("parts of Yaskawa jobs have names of at most 32 characters") {
  const auto problem = [](const std::string& name) {
    std::string text = job_of(jbi_positions_text, "MOVL C00001 V=10\nMOVL C00002 V=10\n");
    text.replace(text.find("PART"), 4, name);
    return diagnostic_of([&] { parts_of(text, 1); });
  };
  CHECK(problem(std::string(30, 'A')) == "none");
  const std::string name(31, 'A');
  CHECK(problem(name) ==
        "part.jbi:1:1: error: the program cannot be divided into parts: the name of its part " + name +
            "_1 is longer than the 32 characters of a name of a job; divide it where it was "
            "posted, or give --max-points a larger number");
}

TEST_CASE("a corrected Yaskawa job with new positions is divided") {
  const Program program =
      read_steps("MOVJ C00001 VJ=25\nMOVL C00002 V=10\nMOVL C00003 V=10\nMOVL C00002 V=10\n");
  const std::string text = shifted_text(program, {0, 0, 1}, {.header = {"COUNTERFLEX 1 TEST"}});
  const std::vector<ProgramPart> parts = parts_of(text, 2);
  REQUIRE(parts.size() == 3);
  std::vector<std::string> targets = targets_of(parts[1].text);
  for (const std::string& target : targets_of(parts[2].text)) targets.push_back(target);
  std::vector<std::string> wanted = targets_of(text);
  wanted.erase(wanted.begin());
  CHECK(targets == wanted);
  CHECK(parts[1].text.find("COUNTERFLEX 1 TEST") != std::string::npos);
}
