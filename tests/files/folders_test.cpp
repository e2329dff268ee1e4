#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"
#include "files/folder.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("a folder is created with its missing parents, and an existing one is not changed") {
  const Folder folder;
  for (const char* path : {"a/b/c", "a/b/c", "d/", "d/e//f/", "."}) {
    CAPTURE(path);
    make_folder(folder.file(path));
    CHECK(std::filesystem::is_directory(folder.file(path)));
  }
}

TEST_CASE("the error for a folder that cannot be created has its name") {
  const Folder folder;
  write_file(folder.file("file"), "x");
  for (const char* path : {"file", "file/below", "file/far/below"}) {
    CAPTURE(path);
    try {
      make_folder(folder.file(path));
      FAIL("it was made");
    } catch (const InputError& error) {
      CHECK(error.kind() == ErrorKind::usage);
      CHECK(error.where().file.starts_with(folder.file("file")));
    }
  }
  CHECK(read_file(folder.file("file")) == "x");
}

TEST_CASE("syncing a missing folder is an error") {
  const Folder folder;
  CHECK_NOTHROW(sync_folder(folder.path.string()));
  CHECK_THROWS_AS(sync_folder(folder.file("missing")), InputError);
}
