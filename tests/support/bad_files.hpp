#pragma once
/// Bad inputs with their expected diagnostics.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"

namespace counterflex {

/// The diagnostic of `read` for a bad machine, force, job or project file, or "none".
template <class Read>
std::string diagnostic_of(const Read& read, const std::string& text, const std::string& name) {
  try {
    read(text, name);
  } catch (const InputError& error) {
    CHECK(error.kind() == ErrorKind::machine_or_force);
    CHECK(error.where().file == name);
    return error.what();
  }
  return "none";
}

/// The first line of every .toml file of tests/bad/FOLDER (at least `least` files) has, after "# expect: ",
/// the diagnostic that it must cause in `read(text, name)`, without the name of the file.
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
