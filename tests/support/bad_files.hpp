#pragma once
/// Bad inputs that say themselves what is wrong with them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"

namespace counterflex {

/// What `read` says of a bad machine, force, job or project file; "none" where it takes it.
template <class Read>
std::string diagnostic_of(const Read& read, const std::string& text, const std::string& name) {
  try {
    read(text, name);
  } catch (const InputError& error) {
    CHECK(error.exit() == Exit::machine_or_force);
    CHECK(error.where().file == name);
    return error.what();
  }
  return "none";
}

/// Every .toml file of tests/bad/FOLDER, of which there are at least `least`, says in its first line, behind
/// "# expect: ", which diagnostic it must cause in `read(text, name)`, without the name of the file.
template <class Read>
void check_bad_files(const std::string& folder, std::size_t least, const Read& read) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(COUNTERFLEX_SOURCE_DIR "/tests/bad/" + folder))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  REQUIRE(files.size() >= least);
  for (const auto& path : files) {
    const std::string name = path.filename().string(), text = read_file(path.string()), mark = "# expect: ";
    CAPTURE(name);
    REQUIRE(text.starts_with(mark));
    const std::string expected = text.substr(mark.size(), text.find('\n') - mark.size());
    CHECK(diagnostic_of(read, text, name) == name + ":" + expected);
  }
}

}  // namespace counterflex
