// KUKA programs whose data list is read behind the loop that uses it, window by window.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <vector>

#include "counterflex/program/program_files.hpp"
#include "counterflex/program/program_reader.hpp"
#include "files/folder.hpp"
#include "program/robot/edits.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

constexpr int targets = 9000;

const std::string long_program =
    "&ACCESS RVP\n"
    "DEF job( )\n"
    "INT n\n"
    "$BASE={X 100,Y 0,Z 0,A 0,B 0,C 0}\n"
    "PTP {X 0,Y 0,Z 40,A 0,B 0,C 0}\n"
    "LIN {X 0,Y 0,Z 5,A 0,B 0,C 0} C_DIS\n"
    ";RING\n"
    "FOR n = 1 TO 9000\n"
    "  LIN POINTS[n].at C_DIS ;next\n"
    "ENDFOR\n"
    ";UP\n"
    "$VEL.CP=0.05\n"
    "LIN {X 0,Y 0,Z 10,A 0,B 0,C 0} C_DIS\n"
    "HOMING()\n"
    "PTP {X 0,Y 0,Z 40,A 0,B 0,C 0}\n"
    "END\n";

std::string list_text(const std::string& end = "ENDDAT\n") {
  std::string text =
      "DEFDAT job PUBLIC\n;made by hand\n\nSTRUC target FRAME at, REAL f\n"
      "DECL E6POS XHOME={X 1,Y 2,Z 3,A 0,B 0,C 0}\nDECL GLOBAL target POINTS[ 9000 ]\n";
  for (int i = 1; i <= targets; ++i)
    text += fmt::format("POINTS[{:<6}]={{at {{X {},Y {},Z 0,A 0,B 0,C {}}},f 0.1}}{}\n", i, 2 * i, i % 7,
                        i % 90, i % 1000 == 0 ? " ;thousand" : "");
  return text + end;
}

/// The two files of a program in a folder.
struct Files {
  Folder folder{};
  std::vector<std::string> paths{folder.file("job.src"), folder.file("job.dat")};

  Files(const std::string& src, const std::string& dat) {
    std::ofstream(paths[0], std::ios::binary) << src;
    std::ofstream(paths[1], std::ios::binary) << dat;
  }
};

std::string all_of(FileReader bytes) {
  std::string text;
  while (bytes.append(text, 1 << 16) > 0) {
  }
  return text;
}

bool follows(const std::string& src, const std::string& dat = list_text()) {
  return join_files_by_motion(Files(src, dat).paths).has_value();
}

std::string with(const std::string& old, const std::string& by, std::string text = long_program) {
  const std::size_t at = text.find(old);
  REQUIRE(at != std::string::npos);
  return text.replace(at, old.size(), by);
}

/// Each seventh move gets a point in its middle, and all are shifted.
std::vector<MoveEdit> edits_of(const Program& window, std::size_t first) {
  std::vector<MoveEdit> edits = robot_edits(window);
  std::erase_if(edits, [&](const MoveEdit& edit) { return !all_known(window.moves[edit.move].known_end); });
  for (MoveEdit& edit : edits) {
    const Move& move = window.moves[edit.move];
    edit.end_mm.z() += 0.25;
    if (move.may_split && (first + edit.move) % 7 == 3)
      edit.inserted.push_back({.end_mm = (move.start_mm + move.end_mm) / 2 + Vector3(0, 0, 0.125),
                               .orientation = move.orientation->end});
  }
  return edits;
}

std::array<std::string, 2> files_of(const std::string& text) {
  std::array<std::string, 2> files;
  FileSplitter splitter([&](std::size_t file, std::string_view bytes) { files.at(file) += bytes; });
  splitter.add(text);
  splitter.finish();
  return files;
}

}  // namespace

TEST_CASE("a data list behind its loop gives the moves and lines of the list behind the program") {
  for (const std::string end : {"ENDDAT\n", "ENDDAT", "ENDDAT\n\n;end\n"}) {
    const Files files(long_program, list_text(end));
    const Program whole = read_program(all_of(join_files(files.paths)), "job.src", {});
    auto bytes = join_files_by_motion(files.paths);
    REQUIRE(bytes);
    ProgramReader reader(*bytes, "job.src", {});
    std::size_t windows = 0, next = 0, left_alone = 0;
    while (reader.next()) {
      const Program& window = reader.window();
      ++windows;
      left_alone += window.left_alone.size();
      CHECK(std::is_sorted(window.moves.begin(), window.moves.end(),
                           [](const Move& a, const Move& b) { return line_in_text(a) < line_in_text(b); }));
      for (const Move& move : window.moves) {
        CAPTURE(next);
        const Move& same = whole.moves.at(next++);
        const bool at_same_line = move.line == same.line && line_in_text(move) == line_in_text(same);
        const bool to_same_target = move.start_mm == same.start_mm && move.end_mm == same.end_mm &&
                                    move.orientation->end == same.orientation->end;
        const bool in_same_way = move.feed_mm_min == same.feed_mm_min && move.may_split == same.may_split &&
                                 window.operations.at(move.operation) == whole.operations.at(same.operation);
        CHECK((at_same_line && to_same_target && in_same_way));
      }
    }
    CHECK(next == whole.moves.size());
    CHECK(left_alone == whole.left_alone.size());
    CHECK(windows > 3);
    CHECK(reader.window().block_count == whole.block_count);
  }
}

TEST_CASE("targets inserted into a list behind its loop give the files of the list behind the program") {
  const Files files(long_program, list_text());
  const Program whole = read_program(all_of(join_files(files.paths)), "job.src", {});
  const WriteOptions options{.header = {"COUNTERFLEX 1"}};
  const auto expected = files_of(rewrite(whole, edits_of(whole, 0), options).text);
  auto bytes = join_files_by_motion(files.paths);
  REQUIRE(bytes);
  ProgramReader reader(*bytes, "job.src", {});
  TextReader corrected(reader);
  Rewriter rewriter(options);
  std::string text;
  std::size_t moves = 0, read_back = 0;
  while (reader.next()) {
    const std::string written = rewriter.write(reader.window(), edits_of(reader.window(), moves)).text;
    moves += reader.window().moves.size();
    read_back += corrected.read(written).moves.size();
    text += written;
  }
  auto [src, dat] = files_of(text);
  LoopCount count = loop_count_of(src);
  add_elements(dat, count);
  CHECK(count.array == "POINTS");
  CHECK(count.last > targets + 1000);
  CHECK(with_loop_end(src, count) == expected[0]);
  CHECK(with_array_size(dat, count) == expected[1]);
  CHECK(expected[0].find(fmt::format("FOR n = 1 TO {}\n", count.last)) != std::string::npos);
  CHECK(read_back == moves + static_cast<std::size_t>(count.last) - targets);
  const Files again(expected[0], expected[1]);
  REQUIRE(join_files_by_motion(again.paths));
  CHECK(files_of(all_of(std::move(*join_files_by_motion(again.paths)))) == expected);
}

TEST_CASE("a list follows its loop only if no line far away matters") {
  CHECK(follows(long_program));
  CHECK(!follows(with("HOMING()", "PTP XHOME")));
  CHECK(!follows(with("HOMING()", "LIN POINTS[3].at")));
  CHECK(!follows(with("INT n", "INT n\nDECL FRAME P1={X 1,Y 2,Z 3,A 0,B 0,C 0}")));
  CHECK(!follows(with("HOMING()", "FOR n = 1 TO 3\nLIN OTHERS[n]\nENDFOR")));
  CHECK(!follows(long_program + "DEF HOMING()\nEND\n"));
  CHECK(!follows(with("  LIN", "  POINTS[n].at.A = 3\n  LIN")));
  CHECK(!follows(with("TO 9000", "TO 8999")));
  CHECK(!follows(with("FOR n = 1", "FOR n = 2")));
  CHECK(!follows(long_program + std::string(200'000, ' ')));
  CHECK(!follows(long_program, with("[ 9000 ]", "[ 9000 ]\nOTHERS[1]={X 1}", list_text())));
  CHECK(!follows(long_program, with("DECL GLOBAL target POINTS[ 9000 ]", ";", list_text())));
  CHECK(!follows(long_program, with("POINTS[4     ]", "POINTS[5     ]", list_text())));
  Files three(long_program, list_text());
  three.paths.push_back(three.paths[1]);
  CHECK(!join_files_by_motion(three.paths));
}

TEST_CASE("an array that is declared too small is refused in a list behind its loop, too") {
  const Files files(long_program, with("[ 9000 ]", "[ 8999 ]", list_text()));
  auto bytes = join_files_by_motion(files.paths);
  REQUIRE(bytes);
  ProgramReader reader(*bytes, "job.src", {});
  const std::string diagnostic = diagnostic_of([&] { reader.next(); });
  CHECK(diagnostic.find("job.src:24:27: error: 'POINTS' is declared with 8999 elements") == 0);
}
