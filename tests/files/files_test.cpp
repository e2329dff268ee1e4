#include "counterflex/files/files.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "counterflex/files/input_error.hpp"
#include "files/folder.hpp"

using namespace counterflex;
using namespace counterflex::test;
namespace fs = std::filesystem;

namespace {

/// Replaces a standard stream by another file until it is destroyed.
struct Redirected {
  int stream, saved;
  Redirected(int fd, const std::string& path, int flags) : stream(fd), saved(::dup(fd)) {
    const int file = ::open(path.c_str(), flags, 0600);
    REQUIRE(file >= 0);
    ::dup2(file, stream);
    ::close(file);
  }
  ~Redirected() {
    ::dup2(saved, stream);
    ::close(saved);
  }
};

template <class Action>
InputError error_of(Action action) {
  try {
    action();
  } catch (const InputError& error) {
    return error;
  }
  FAIL("no InputError was thrown");
  return InputError(ErrorKind::internal, {}, "");
}

bool mentions(const InputError& error, const std::string& text) {
  return std::string(error.what()).find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("reading a written file restores every byte") {
  const Folder folder;
  std::string bytes = "G1 X1\r\n\0\xff end without line end";
  bytes += '\0';
  bytes += std::string(300000, 'x');
  write_file(folder.file("a.ngc"), bytes);
  CHECK(read_file(folder.file("a.ngc")) == bytes);
  write_file(folder.file("a.ngc"), "");
  CHECK(read_file(folder.file("a.ngc")).empty());
  CHECK(folder.count() == 1);
}

TEST_CASE("a file that cannot be read is a usage error that names path and reason") {
  const Folder folder;
  const auto missing = error_of([&] { read_file(folder.file("no.ngc")); });
  CHECK(missing.kind() == ErrorKind::usage);
  CHECK(mentions(missing, folder.file("no.ngc")));
  CHECK(mentions(missing, "No such file or directory"));
  const auto directory = error_of([&] { read_file(folder.path.string()); });
  CHECK(directory.kind() == ErrorKind::usage);
  CHECK(mentions(directory, "Is a directory"));
}

TEST_CASE("a new file has the permissions 0644 less the umask, an old one keeps its own") {
  const Folder folder;
  const auto mode = [&] {
    struct stat status {};
    REQUIRE(::stat(folder.file("a").c_str(), &status) == 0);
    return status.st_mode & 0777;
  };
  const mode_t before = ::umask(0027);
  write_file(folder.file("a"), "1");
  ::umask(before);
  CHECK(mode() == 0640);
  REQUIRE(::chmod(folder.file("a").c_str(), 0604) == 0);
  write_file(folder.file("a"), "2");
  CHECK(mode() == 0604);
}

TEST_CASE("a write to a path that is not a file is a usage error with the path, and leaves no trace") {
  const Folder folder;
  const auto no_folder = error_of([&] { write_file(folder.file("none/a"), "1"); });
  CHECK(no_folder.kind() == ErrorKind::usage);
  CHECK(mentions(no_folder, folder.file("none/a")));
  fs::create_directory(folder.path / "taken");
  const auto taken = error_of([&] { write_file(folder.file("taken"), "1"); });
  CHECK(taken.kind() == ErrorKind::usage);
  CHECK(mentions(taken, "Is a directory"));
  CHECK(folder.count() == 1);
}

TEST_CASE("a folder without write permission is refused and the old file is unchanged") {
  if (::geteuid() == 0) return;  // root may write anywhere
  const Folder folder;
  write_file(folder.file("a"), "old");
  fs::permissions(folder.path, fs::perms::owner_read | fs::perms::owner_exec);
  CHECK(error_of([&] { write_file(folder.file("a"), "new"); }).kind() == ErrorKind::usage);
  fs::permissions(folder.path, fs::perms::owner_all);
  CHECK(read_file(folder.file("a")) == "old");
  CHECK(folder.count() == 1);
}

TEST_CASE("a full device is an error, and a device is never replaced by a file") {
  const auto full = error_of([] { write_file("/dev/full", "1"); });
  CHECK(full.kind() == ErrorKind::transient_io);
  CHECK(mentions(full, "No space left on device"));
  CHECK(fs::is_character_file("/dev/full"));
}

TEST_CASE("a dash is standard input and standard output") {
  const Folder folder;
  {
    std::fflush(stdout);
    const Redirected output(STDOUT_FILENO, folder.file("out"), O_WRONLY | O_CREAT);
    std::fputs("before ", stdout);
    write_file("-", "bytes\r\n");
  }
  CHECK(read_file(folder.file("out")) == "before bytes\r\n");
  const Redirected input(STDIN_FILENO, folder.file("out"), O_RDONLY);
  CHECK(read_file("-") == "before bytes\r\n");
}

TEST_CASE("a standard output that accepts no bytes is an error") {
  std::string what;
  std::optional<ErrorKind> kind;
  {
    std::fflush(stdout);
    const Redirected output(STDOUT_FILENO, "/dev/full", O_WRONLY);
    const auto error = error_of([] { write_file("-", "bytes"); });
    what = error.what();
    kind = error.kind();
  }
  CHECK(kind == ErrorKind::transient_io);
  CHECK(what == "error: cannot write standard output: No space left on device");
}

TEST_CASE("writing through a symbolic link replaces its target and keeps the link") {
  const Folder folder;
  write_file(folder.file("real"), "old");
  fs::create_symlink("real", folder.path / "link");
  write_file(folder.file("link"), "new");
  CHECK(fs::is_symlink(folder.path / "link"));
  CHECK(read_file(folder.file("real")) == "new");
}

TEST_CASE("a broken symbolic link is refused as output and is not changed") {
  const Folder folder;
  fs::create_symlink("missing", folder.path / "link");
  fs::create_symlink("loop", folder.path / "loop");
  for (const char* name : {"link", "loop"}) {
    const auto error = error_of([&] { write_file(folder.file(name), "new"); });
    CHECK(error.kind() == ErrorKind::usage);
    CHECK(mentions(error, "symbolic link"));
    CHECK(fs::is_symlink(folder.path / name));
  }
  CHECK(folder.count() == 2);
}

TEST_CASE("names of up to 255 bytes can be written, longer ones are a usage error") {
  const Folder folder;
  for (const std::size_t bytes : {200, 221, 244, 255}) {
    const std::string path = folder.file(std::string(bytes, 'n'));
    write_file(path, "new");
    CHECK(read_file(path) == "new");
  }
  CHECK(error_of([&] { write_file(folder.file(std::string(256, 'n')), "new"); }).kind() == ErrorKind::usage);
  CHECK(folder.count() == 4);
}

TEST_CASE("SHA-256 gives the digests of the standard's examples") {
  CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256(std::string(1000000, 'a')) ==
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("SHA-256 of portions is that of the whole") {
  Sha256 hash;
  hash.add("ab");
  hash.add("");
  hash.add("c");
  CHECK(hash.digits() == sha256("abc"));
}

// RFC 4648, section 10; the digest is that of FIPS 180-2, appendix B.1.
TEST_CASE("base64 follows its standard, and integrity encodes the digest's bytes") {
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(integrity("abc") == "sha256-ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0=");
}

TEST_CASE("a missing file is a usage error, a read failure is a temporary error") {
  const Folder folder;
  for (const std::string& path : {folder.file("missing"), folder.file("missing/below"), std::string("/")})
    CHECK(error_of([&] { read_file(path); }).kind() == ErrorKind::usage);
  const InputError error = error_of([] { read_file("/proc/self/mem"); });  // reading its beginning fails
  CHECK(error.kind() == ErrorKind::transient_io);
  CHECK(mentions(error, "cannot read the file: Input/output error"));
}
