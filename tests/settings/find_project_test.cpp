#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "counterflex/files/files.hpp"
#include "counterflex/settings/project_file.hpp"

using namespace counterflex;

namespace {

namespace fs = std::filesystem;

/// A new folder that is the working directory until it is destroyed.
class TemporaryFolder {
 public:
  TemporaryFolder() : before_(fs::current_path()) {
    path_ = fs::temp_directory_path() / ("counterflex-find-" + std::to_string(getpid()));
    fs::create_directories(path_ / "shop/parts");
    fs::current_path(path_);
  }
  ~TemporaryFolder() {
    fs::current_path(before_);
    fs::remove_all(path_);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path before_, path_;
};

void project_in(const std::string& folder) {
  write_file((fs::path(folder) / "counterflex.toml").string(), "format = \"counterflex-project 1\"\n");
}

}  // namespace

TEST_CASE("the nearest project file above a program is found, by its path from the working directory") {
  const TemporaryFolder folder;
  project_in("shop");
  CHECK(find_project_file("shop/a.ngc") == "shop/counterflex.toml");
  CHECK(find_project_file("shop/parts/a.ngc") == "shop/counterflex.toml");
  CHECK(find_project_file("shop/parts/../parts/./a.ngc") == "shop/counterflex.toml");
  CHECK(find_project_file("missing/folder/../../shop/a.ngc") == "shop/counterflex.toml");
  project_in("shop/parts");
  CHECK(find_project_file("shop/parts/a.ngc") == "shop/parts/counterflex.toml");
  CHECK(find_project_file((folder.path() / "shop/a.ngc").string()) == "shop/counterflex.toml");
  fs::current_path("shop/parts");
  fs::remove("counterflex.toml");
  CHECK(find_project_file("a.ngc") == "../counterflex.toml");
}

TEST_CASE("without a program's name the search begins in the working directory") {
  const TemporaryFolder folder;
  project_in("shop");
  fs::current_path("shop");
  CHECK(find_project_file("-") == "counterflex.toml");
  CHECK(find_project_file("") == "counterflex.toml");
}

TEST_CASE("in a removed folder there is no project file, except for a program elsewhere") {
  const TemporaryFolder folder;
  project_in("shop");
  const std::string program = (folder.path() / "shop/a.ngc").string();
  fs::create_directory("gone");
  fs::current_path("gone");
  fs::remove(folder.path() / "gone");
  CHECK_FALSE(find_project_file("-").has_value());
  CHECK_FALSE(find_project_file("a.ngc").has_value());
  CHECK(find_project_file(program) == (folder.path() / "shop/counterflex.toml").string());
}

TEST_CASE("a folder with the name of a project file is ignored") {
  const TemporaryFolder folder;
  project_in("shop");
  fs::create_directory("shop/parts/counterflex.toml");
  CHECK(find_project_file("shop/parts/a.ngc") == "shop/counterflex.toml");
}

TEST_CASE("a broken link is found and fails when it is read; a link to a folder is ignored") {
  const TemporaryFolder folder;
  project_in("shop");
  fs::create_symlink("nowhere.toml", "shop/parts/counterflex.toml");
  CHECK(find_project_file("shop/parts/a.ngc") == "shop/parts/counterflex.toml");
  fs::remove("shop/parts/counterflex.toml");
  fs::create_symlink("..", "shop/parts/counterflex.toml");
  CHECK(find_project_file("shop/parts/a.ngc") == "shop/counterflex.toml");
}

TEST_CASE("a pipe with the name of a project file is refused") {
  const TemporaryFolder folder;
  REQUIRE(mkfifo("shop/counterflex.toml", 0600) == 0);
  CHECK_THROWS_WITH_AS(find_project_file("shop/a.ngc"),
                       "shop/counterflex.toml: error: cannot read the file: it is a pipe or a device, and "
                       "must be a regular file",
                       InputError);
}
