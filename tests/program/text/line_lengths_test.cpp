#include <doctest/doctest.h>

#include <string>

#include "counterflex/program/overview.hpp"

using namespace counterflex;

TEST_CASE("lines above nine tenths of the control's limit are near it") {
  const std::string text = "G1 X1\r\n" + std::string(229, 'X') + "\r\n" + std::string(230, 'X') + "\n" +
                           std::string(240, 'X') + "\n" + std::string(231, 'X');
  const LineLengths lengths = line_lengths(text, "linuxcnc");
  CHECK(lengths.limit == 255);
  CHECK(lengths.longest == 240);
  CHECK(lengths.longest_line == 4);
  CHECK(lengths.near == 3);
  CHECK(lengths.first_near == 3);
}

TEST_CASE("characters that the control drops are not counted") {
  const std::string text = "(" + std::string(200, 'c') + ")\nG1 X1 Y1 ;" + std::string(200, 'c') + "\n";
  const LineLengths lengths = line_lengths(text, "grbl");
  CHECK(lengths.limit == 80);
  CHECK(lengths.longest == 6);
  CHECK(lengths.longest_line == 2);
  CHECK(lengths.near == 0);
}

TEST_CASE("a control without a limit has no lines near it") {
  CHECK(line_lengths(std::string(1000, 'X'), "fanuc").limit == 0);
  CHECK(line_lengths(std::string(1000, 'X'), "fanuc").longest == 0);
}

TEST_CASE("lines measured in portions equal those of the whole text") {
  const std::string text = "G1 X1\r\n" + std::string(231, 'X') + "\r\n\n" + std::string(240, 'X') +
                           "\n(comment)\n" + std::string(240, 'Y');
  const LineLengths whole = line_lengths(text, "linuxcnc");
  CHECK(whole.lines == 6);
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    if (cut > 0 && cut < text.size() && text[cut - 1] != '\n') continue;
    CAPTURE(cut);
    LineLengths lengths;
    add_lines(lengths, std::string_view(text).substr(0, cut), "linuxcnc");
    add_lines(lengths, std::string_view(text).substr(cut), "linuxcnc");
    CHECK(lengths.lines == whole.lines);
    CHECK(lengths.longest == whole.longest);
    CHECK(lengths.longest_line == whole.longest_line);
    CHECK(lengths.near == whole.near);
    CHECK(lengths.first_near == whole.first_near);
  }
}
