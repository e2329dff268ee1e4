#include "counterflex/program/last_words.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "counterflex/program/program_reader.hpp"
#include "counterflex/program/rewrite.hpp"

using namespace counterflex;

namespace {

auto words_before(std::size_t end, const std::string& text) {
  FileReader bytes = FileReader::of_bytes(text);
  return last_words_before(end, bytes, "part.ngc", {});
}

}  // namespace

TEST_CASE("the last words of each axis are found where their blocks begin, wherever windows end") {
  const std::string text = "G21 G90\nG0 X1 Y1 Z5\nG1 Z1 F100\nX2\nY2\n";
  const auto last = words_before(text.size(), text);
  CHECK(last[0] == text.find("X2"));
  CHECK(last[1] == text.find("Y2"));
  CHECK(last[2] == text.find("G1 Z1"));
  const auto before = words_before(text.find("X2"), text);
  CHECK(before[0] == text.find("G0 X1"));
  CHECK(before[2] == text.find("G1 Z1"));
  std::string longer = text;
  for (int k = 0; k < 10000; ++k) longer += fmt::format("X{} Y{}\n", k % 40, k % 7);
  CHECK(words_before(longer.size(), longer)[2] == text.find("G1 Z1"));
  CHECK(words_before(longer.size(), longer)[0] == longer.rfind('X'));
}

TEST_CASE("nothing is found where no move has said an axis, and nothing in a window that cannot be read") {
  CHECK_FALSE(words_before(0, "G21 X1\n")[0]);
  std::string text = "G21 G90\nG0 X0 Y0 Z0\n";
  for (int k = 0; k < 5000; ++k) text += fmt::format("X{} Y{}\n", k % 40, k % 7);
  const std::size_t end = text.size();
  text += "Z1 F\n";
  CHECK(words_before(text.size(), text)[0] > end / 2);
  CHECK(words_before(text.size(), text)[0] < end);
  CHECK(words_before(text.size(), text)[2] == text.find("G0 X0"));
}

TEST_CASE("a rewriter goes on behind a window that another has written") {
  const std::string text = "G21 G90\r\nG0 X0 Y0 Z0\r\nG1 X1 Z1 F100\r\nX2 Y2\r\nX3\r\nX4 Y1\r\n";
  FileReader bytes = FileReader::of_bytes(text);
  ProgramReader reader(bytes, "part.ngc", {}, 1);
  Rewriter one({.header = {"HEADER"}}), other({.header = {"HEADER"}});
  std::string whole, rest;
  for (std::size_t w = 0; reader.next(); ++w) {
    const Program& window = reader.window();
    std::vector<MoveEdit> edits;
    for (std::size_t m = 0; m < window.moves.size(); ++m)
      edits.push_back({.move = m, .end_mm = window.moves[m].end_mm + Vector3(0, 0.25, 0.5)});
    const std::string written = one.write(window, edits).text;
    whole += written;
    if (w < 2)
      other.pass(window, one.state());
    else
      rest += other.write(window, edits).text;
  }
  CHECK(rest.size() > 10);
  CHECK(whole.ends_with(rest));
  CHECK(rest.find("HEADER") == std::string::npos);
}
