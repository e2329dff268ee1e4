#include "counterflex/files/file_writer.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <set>
#include <vector>

#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/files/system.hpp"
#include "files/descriptor.hpp"

namespace counterflex {

/// Names of temporary files, in memory that a signal handler may read.
struct UnpublishedName {
  std::atomic<bool> taken{false}, complete{false};
  char path[4096];
};
static std::array<UnpublishedName, 16> unpublished;

/// Registers `path` until it is destroyed, if there is room.
class Unpublished {
 public:
  explicit Unpublished(const std::string& path) {
    for (UnpublishedName& name : unpublished) {
      if (path.size() >= sizeof name.path || name.taken.exchange(true)) continue;
      std::memcpy(name.path, path.c_str(), path.size() + 1);
      name.complete = true;
      name_ = &name;
      return;
    }
  }
  ~Unpublished() {
    if (name_ == nullptr) return;
    name_->complete = false;
    name_->taken = false;
  }
  Unpublished(const Unpublished&) = delete;
  Unpublished& operator=(const Unpublished&) = delete;

 private:
  UnpublishedName* name_ = nullptr;
};

namespace {

/// A new file beside `path` with a unique name.
std::pair<std::string, int> create_beside(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  for (;;) {
    std::string name = temporary_name(path, ::getpid(), counter++);
    const int fd = system::make_file(name);
    if (fd >= 0 || errno != EEXIST) return {std::move(name), fd};
  }
}

Descriptor open_stream(const std::string& path) {
  if (path == "-") {
    std::fflush(stdout);
    return Descriptor(STDOUT_FILENO);
  }
  Descriptor device(system::open_stream(path));
  if (device.get() < 0) fail_writing(path);
  return device;
}

}  // namespace

struct FileWriter::State {
  std::string path;
  std::string target{};     ///< the file that gets the name; empty for streams
  std::string temporary{};  ///< its name until then
  std::optional<Unpublished> known{};
  Descriptor file{};
  Descriptor kept{};  ///< so that the complete file is not taken to be abandoned before it has its name
  std::string buffer{};
  bool is_complete = false;
  std::optional<Sha256> hash{};
  std::string digits{};  ///< of the hash, once it is complete

  ~State() {
    if (!temporary.empty()) system::remove_file(temporary.c_str());
  }
  void flush() {
    if (!write_all(file.get(), buffer)) fail_writing(path);
    buffer.clear();
  }
};

FileWriter::FileWriter(const std::string& path) : state_(new State{.path = path}) {
  const auto facts = path == "-" ? std::nullopt : system::facts_of(path);
  const bool exists = facts.has_value();
  // Devices and pipes are written directly: they cannot be replaced by renaming.
  if (path == "-" || (exists && facts->kind == system::FileKind::stream)) {
    state_->file = Descriptor(system::make_nameless_file());
  } else {
    std::error_code ignored;
    if (!exists && std::filesystem::is_symlink(std::filesystem::symlink_status(path, ignored)))
      throw InputError(ErrorKind::usage, {path},
                       "is a symbolic link to a file that does not exist, or to itself; remove it, or give "
                       "another name");
    state_->target = exists ? std::filesystem::canonical(path, ignored).generic_string() : path;
    if (state_->target.empty()) state_->target = path;
    auto [name, fd] = create_beside(state_->target);
    state_->file = Descriptor(fd);
    if (fd >= 0) {
      state_->known.emplace(name);
      state_->temporary = std::move(name);
    }
    if (fd >= 0 && exists && !system::set_mode(fd, facts->mode)) fail_writing(path);
  }
  if (state_->file.get() < 0) fail_writing(path);
}

FileWriter::~FileWriter() = default;
FileWriter::FileWriter(FileWriter&&) noexcept = default;

void FileWriter::hash_along() {
  state_->hash.emplace();
}

const std::string& FileWriter::sha256() const {
  return state_->digits;
}

const std::string& FileWriter::path() const {
  return state_->path;
}

void FileWriter::write(std::string_view bytes) {
  if (state_->hash) state_->hash->add(bytes);
  if (state_->buffer.size() + bytes.size() >= portion) state_->flush();
  if (bytes.size() < portion)
    state_->buffer += bytes;
  else if (!write_all(state_->file.get(), bytes))
    fail_writing(state_->path);
}

bool FileWriter::is_stream() const {
  return state_->target.empty();
}

void FileWriter::complete() {
  State& s = *state_;
  if (s.is_complete) return;
  s.flush();
  if (!is_stream()) s.kept = Descriptor(::dup(s.file.get()));
  if (!is_stream() && (!system::flush_to_disk(s.file.get()) || !s.file.close())) fail_writing(s.path);
  if (s.hash) s.digits = s.hash->digits();
  s.is_complete = true;
}

void FileWriter::publish() {
  complete();
  if (is_stream()) return send();
  rename();
  sync_folder(folder_of(state_->target));
}

void FileWriter::publish_files(const std::vector<FileWriter*>& files) {
  std::set<std::string> folders;
  for (FileWriter* file : files) file->complete();
  for (FileWriter* file : files) {
    file->rename();
    folders.insert(folder_of(file->state_->target));
  }
  for (const std::string& folder : folders) sync_folder(folder);
}

void FileWriter::rename() {
  State& s = *state_;
  if (!system::rename_file(s.temporary, s.target)) fail_writing(s.path);
  s.temporary.clear();
  s.known.reset();
  s.kept = Descriptor();
}

void FileWriter::send() {
  const State& s = *state_;
  const Descriptor stream = open_stream(s.path);
  if (::lseek(s.file.get(), 0, SEEK_SET) != 0) fail_writing(s.path);
  std::vector<char> bytes(portion);
  for (ssize_t n; (n = read_some(s.file.get(), bytes.data(), bytes.size())) != 0;)
    if (n < 0 || !write_all(stream.get(), {bytes.data(), static_cast<std::size_t>(n)})) fail_writing(s.path);
}

void remove_unpublished() noexcept {
  for (const UnpublishedName& name : unpublished)
    if (name.complete) system::remove_file(name.path);
}

}  // namespace counterflex
