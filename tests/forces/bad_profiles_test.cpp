#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>

#include "counterflex/files/files.hpp"
#include "counterflex/forces/read_cutting_model.hpp"
#include "forces/sample_path.hpp"

using namespace counterflex;

namespace {

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

/// What reading the profile and laying it along the sample program says.
std::string diagnostic(const std::string& text, const std::string& file) {
  try {
    if (file.ends_with(".toml")) return read_cutting_model(text, file), "no error";
    ForceSource source;
    source.rules = read_force_csv(text, file);
    test::forces_on(test::sample_program(), source);
  } catch (const InputError& error) {
    CHECK(error.exit() == Exit::machine_or_force);
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("every bad profile is refused with the diagnostic of its first line") {
  const std::string mark = "# expect: ";
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(COUNTERFLEX_SOURCE_DIR "/tests/bad/forces")) {
    const std::string text = read_file(entry.path().string()), file = entry.path().filename().string();
    CAPTURE(file);
    REQUIRE(first_line(text).rfind(mark, 0) == 0);
    CHECK(diagnostic(text, file) == fmt::format("{}:{}", file, first_line(text).substr(mark.size())));
    ++count;
  }
  CHECK(count >= 60);
}
