#include <sys/wait.h>

#include <set>

#include "counterflex/files/file_writer.hpp"
#include "counterflex/files/files.hpp"
#include "files/folder.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// Runs in another process, which then ends.
void begin_and_die(const std::string& path) {
  const pid_t child = ::fork();
  if (child == 0) {
    const FileWriter file(path);
    ::_exit(0);
  }
  int status = -1;
  CHECK(::waitpid(child, &status, 0) == child);
  CHECK(status == 0);
}

}  // namespace

TEST_CASE("a temporary name contains the final name") {
  CHECK(temporary_name("a/b.ngc", 12, 3) == "a/b.ngc.12-3.tmp");
  for (const char* path : {"b.ngc", "b", "b.1-2.tmp", ".b", "12-3"})
    CHECK(wanted_name(temporary_name(path, 4711, 0)) == path);
  for (const char* name : {"b.ngc", "b.tmp", "b.ngc.12.tmp", "b.ngc.12-.tmp", "b.ngc.-3.tmp", "b.ngc.12-3",
                           "12-3.tmp", ".tmp", "", "b.ngc.x12-3.tmp", "b.ngc.12-3x.tmp", "b.ngc12-3.tmp"}) {
    CAPTURE(name);
    CHECK(wanted_name(name).empty());
  }
}

TEST_CASE("only the unfinished files of killed writers are removed") {
  const Folder folder;
  const auto names = [&] {
    std::set<std::string> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path))
      found.insert(entry.path().lexically_relative(folder.path).string());
    return found;
  };
  std::filesystem::create_directories(folder.file("deep"));
  std::filesystem::create_directories(folder.file("a.ngc.7-7.tmp"));
  for (const char* name :
       {"a.ngc", "b.ngc.12-3.tmp", "a.ngc.tmp", "a.ngc.12-3.tmp.bak", "a.ngcc.1-1.tmp", "deep/b.ngc.1-1.tmp"})
    write_file(folder.file(name), "x");
  std::filesystem::create_symlink("a.ngc", folder.file("a.ngc.8-8.tmp"));
  const auto kept = names();
  for (const char* name : {"a.ngc.12-3.tmp", "a.ngc.99999-0.tmp", "deep/a.ngc.1-1.tmp"})
    write_file(folder.file(name), "x");
  CHECK(sweep_temporaries(
            {folder.file("a.ngc"), folder.file("deep/a.ngc"), folder.file("missing/a.ngc"), "", "-"}) == 3);
  CHECK(names() == kept);
}

TEST_CASE(
    "what a writer leaves that ends in the middle is swept, through links and in the present folder, too") {
  const Folder folder;
  std::filesystem::create_directories(folder.file("real"));
  write_file(folder.file("real/a.ngc"), "old");
  std::filesystem::create_symlink("real/a.ngc", folder.file("link.ngc"));
  begin_and_die(folder.file("link.ngc"));
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path);
  begin_and_die("here.ngc");
  CHECK(sweep_temporaries({"link.ngc", "here.ngc"}) == 2);
  std::filesystem::current_path(before);
  CHECK(folder.count() == 2);
  CHECK(read_file(folder.file("real/a.ngc")) == "old");
}

TEST_CASE("with other writers active only unlocked temporary files are removed") {
  const Folder folder;
  const std::string long_name = folder.file(std::string(255, 'n'));
  begin_and_die(folder.file("a.ngc"));
  begin_and_die(long_name);
  const FileWriter alive(folder.file("a.ngc"));
  CHECK(folder.count() == 3);
  CHECK(sweep_abandoned({folder.file("a.ngc"), long_name}) == 2);
  CHECK(folder.count() == 1);
  CHECK(sweep_temporaries({folder.file("a.ngc")}) == 1);
}
