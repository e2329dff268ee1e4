#include "counterflex/batch/folder_lock.hpp"

#include <sys/file.h>
#include <sys/wait.h>

#include <csignal>
#include <utility>

#include "counterflex/files/files.hpp"
#include "files/folder.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

/// The message of an attempt to lock, or "locked".
std::string attempt(const std::string& folder, LockKind kind = LockKind::exclusive,
                    ErrorKind expected = ErrorKind::transient_io) {
  try {
    const FolderLock lock(folder, kind, "counterflex batch other.toml");
    return lock.locked() ? "locked" : lock.why_not();
  } catch (const InputError& error) {
    CHECK(error.kind() == expected);
    return error.what();
  }
}

std::string text_in(const std::string& folder) {
  return read_file(folder + "/.counterflex/lock");
}

/// A process that runs `work`, reports it, and waits until it is killed.
struct Child {
  pid_t pid = -1;
  template <typename Work>
  explicit Child(const Work& work) {
    int ends[2];
    REQUIRE(::pipe(ends) == 0);
    pid = ::fork();
    if (pid == 0) {
      work();
      if (::write(ends[1], "x", 1) == 1)
        for (;;) ::pause();
      ::_exit(1);
    }
    char said = 0;
    CHECK(::read(ends[0], &said, 1) == 1);
    ::close(ends[0]);
    ::close(ends[1]);
  }
  void kill() {
    if (pid < 0) return;
    ::kill(pid, SIGKILL);
    ::waitpid(std::exchange(pid, -1), nullptr, 0);
  }
  ~Child() { kill(); }
};

}  // namespace

TEST_CASE("a folder has one lock holder, refusals name the holder, and release frees the folder") {
  const Folder place;
  const std::string folder = place.file("not/yet/there");
  {
    const FolderLock lock(folder, LockKind::exclusive, "counterflex batch\njobs.toml");
    CHECK(lock.locked());
    const std::string refused = attempt(folder);
    CAPTURE(refused);
    CHECK(refused.starts_with(folder + ": error: another run is active in this folder: process " +
                              std::to_string(::getpid()) + " on "));
    CHECK(refused.ends_with("(counterflex batch jobs.toml)"));
    CHECK(attempt(folder, LockKind::shared) == refused);
    CHECK(text_in(folder).ends_with(' ' + std::to_string(::getpid()) + " counterflex batch jobs.toml\n"));
  }
  CHECK(text_in(folder).empty());
  CHECK(attempt(folder) == "locked");
}

TEST_CASE("a shared lock admits other shared locks and refuses exclusive ones") {
  const Folder place;
  const std::string folder = place.path.string();
  {
    const FolderLock one(folder, LockKind::shared, "counterflex batch jobs.toml --shard 1/2");
    const FolderLock two(folder, LockKind::shared, "counterflex batch jobs.toml --shard 2/2");
    CHECK(two.locked());
    CHECK(attempt(folder).find("another run is active in this folder") != std::string::npos);
    CHECK(text_in(folder).empty());
  }
  CHECK(attempt(folder) == "locked");
}

TEST_CASE("the lock of a dead process is free, and its text is replaced or emptied") {
  for (const LockKind next : {LockKind::exclusive, LockKind::shared}) {
    const Folder place;
    const std::string folder = place.path.string();
    Child holder([&] { new FolderLock(folder, LockKind::exclusive, "counterflex batch jobs.toml"); });
    CHECK(attempt(folder).find("process " + std::to_string(holder.pid) + " on ") != std::string::npos);
    holder.kill();
    CHECK(!text_in(folder).empty());
    const FolderLock lock(folder, next, "counterflex batch jobs.toml --resume");
    CHECK(text_in(folder).find("jobs.toml\n") == std::string::npos);
    CHECK(text_in(folder).empty() == (next == LockKind::shared));
  }
}

TEST_CASE("a child keeps the lock of a dead parent, and does not take it from a living one") {
  const Folder place;
  const std::string folder = place.path.string();
  auto lock = std::make_unique<FolderLock>(folder, LockKind::exclusive, "counterflex batch jobs.toml");
  Child child([&] { lock.reset(); });
  CHECK(text_in(folder).ends_with("counterflex batch jobs.toml\n"));
  CHECK(attempt(folder) != "locked");
  child.kill();
  Child inherits([] {});
  lock.reset();
  CHECK(attempt(folder) != "locked");
  inherits.kill();
  CHECK(attempt(folder) == "locked");
}

TEST_CASE("a lock that is moved is held once") {
  const Folder place;
  const std::string folder = place.path.string();
  FolderLock lock(folder, LockKind::exclusive, "counterflex batch jobs.toml");
  {
    const FolderLock moved = std::move(lock);
    CHECK(attempt(folder) != "locked");
  }
  CHECK(attempt(folder) == "locked");
}

TEST_CASE("a foreign text in the lock file does not prevent locking and is not shown in full") {
  const Folder place;
  const std::string folder = place.path.string(), path = folder + "/.counterflex/lock";
  (void)attempt(folder);
  for (const std::string& text :
       {std::string("x"), std::string("a b c\033[1m\n"), std::string(100000, 'z')}) {
    write_file(path, text);
    const int fd = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
    REQUIRE(::flock(fd, LOCK_EX | LOCK_NB) == 0);
    const std::string refused = attempt(folder);
    CHECK(refused.size() < 2000);
    CHECK(refused.find('\033') == std::string::npos);
    CHECK(refused.find("another run is active") != std::string::npos);
    ::close(fd);
    CHECK(attempt(folder) == "locked");
    CHECK(text_in(folder).empty());
  }
}

TEST_CASE(
    "a folder that cannot be created is a permanent error, a lock that cannot be created a temporary one") {
  const Folder place;
  write_file(place.file("file"), "");
  CHECK(attempt(place.file("file"), LockKind::exclusive, ErrorKind::usage)
            .find("file: error: cannot make the folder: ") != std::string::npos);
  std::filesystem::create_directories(place.file("out/.counterflex/lock"));
  CHECK(attempt(place.file("out")).find("out: error: cannot lock the folder: ") != std::string::npos);
}
