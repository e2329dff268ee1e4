#include <doctest/doctest.h>

#include "counterflex/files/input_error.hpp"
#include "counterflex/files/text.hpp"

using namespace counterflex;

TEST_CASE("control characters are shown by their codes, other text stays") {
  CHECK(without_controls("mill \xc3\xa4 \xe2\x88\x92 5") == "mill \xc3\xa4 \xe2\x88\x92 5");
  CHECK(without_controls("\x1b]0;owned\a\x1b[2J") == "\\x1B]0;owned\\x07\\x1B[2J");
  CHECK(without_controls("a\nb\rc\td\x7f") == "a\\x0Ab\\x0Dc d\\u007F");
  CHECK(without_controls("a\xe2\x80\xae"
                         "b\xe2\x81\xa6\xc2\x9b"
                         "1m") == "a\\u202Eb\\u2066\\u009B1m");
  CHECK(without_controls("\xff\xe2") == "\xff\xe2");
}

TEST_CASE("line ends of a text are kept") {
  CHECK(lines_without_controls("a\x1b\n\nb\r\n") == "a\\x1B\n\nb\\x0D\n");
}

TEST_CASE("a diagnostic is one line without control characters, for any quoted text") {
  const InputError error(ErrorKind::program_text, {"a\nb\x1b[2J", 3, 1}, "unknown '\xe2\x80\xae'");
  CHECK(std::string(error.what()) == "a\\x0Ab\\x1B[2J:3:1: error: unknown '\\u202E'");
}
