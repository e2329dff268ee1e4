#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>

#include "counterflex/files/files.hpp"
#include "forces/sample_path.hpp"

using namespace counterflex;

namespace {

const std::string folder = COUNTERFLEX_SOURCE_DIR "/tests/bad/forces";

/// The text after `mark` in the line that begins with it, or empty.
std::string marked(const std::string& text, const std::string& mark) {
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) return "";
  const std::size_t begin = at + mark.size();
  return text.substr(begin, text.find('\n', begin) - begin);
}

std::vector<ForceRule> rules_in(const std::string& text, const std::string& file) {
  return file.ends_with(".toml") ? read_force_toml(text, file) : read_force_csv(text, file);
}

/// Further rules: a file of the folder `with`, or a --force.
std::vector<ForceRule> others(const std::string& with) {
  if (with.empty()) return {};
  if (!with.ends_with(".csv")) return {parse_force_rule(with)};
  return read_force_csv(read_file(folder + "/with/" + with), with);
}

/// The diagnostic of reading the profile and applying it to the sample program.
std::string diagnostic(const std::string& text, const std::string& file) {
  try {
    ForceSource source;
    source.rules = others(marked(text, "# with: "));
    for (const ForceRule& rule : rules_in(text, file)) source.rules.push_back(rule);
    test::forces_on(test::sample_program(), source);
  } catch (const InputError& error) {
    CHECK(error.kind() == ErrorKind::machine_or_force);
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("every bad profile is refused with the diagnostic of its first line") {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_directory()) continue;
    const std::string text = read_file(entry.path().string()), file = entry.path().filename().string();
    CAPTURE(file);
    const std::string expected = marked(text, "# expect: ");
    REQUIRE(text.rfind("# expect: ", 0) == 0);
    // Only a diagnostic of another file, or of the program, has its name.
    const bool of_other = expected.find(":") != expected.find_first_not_of("0123456789");
    CHECK(diagnostic(text, file) == (of_other ? expected : fmt::format("{}:{}", file, expected)));
    ++count;
  }
  CHECK(count >= 80);
}
