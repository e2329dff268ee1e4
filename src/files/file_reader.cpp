#include "counterflex/files/file_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <optional>
#include <vector>

#include "counterflex/files/files.hpp"
#include "counterflex/files/input_error.hpp"
#include "counterflex/files/system.hpp"
#include "files/descriptor.hpp"

namespace counterflex {

namespace {

// Copies a pipe to a file that can be read again.
Descriptor copied(const std::string& path, const Descriptor& pipe) {
  Descriptor file(system::make_nameless_file());
  if (file.get() < 0) fail_reading(path);
  std::vector<char> buffer(portion);
  for (;;) {
    const ssize_t n = read_some(pipe.get(), buffer.data(), buffer.size());
    if (n < 0 || !write_all(file.get(), {buffer.data(), static_cast<std::size_t>(n)})) fail_reading(path);
    if (n == 0) break;
  }
  return file;
}

}  // namespace

struct FileReader::State {
  std::string path;
  Descriptor file{};
  off_t start = 0;                            ///< of the unread part of standard input
  std::optional<system::FileFacts> opened{};  ///< state of the file when it was opened, to detect changes
  std::optional<std::string> held{};          ///< instead of a file
  std::vector<FileReader> parts{};            ///< instead of a file
  std::size_t part = 0;                       ///< the part that is read
  std::size_t next = 0;                       ///< next byte to read, counted from `start`
  std::optional<Sha256> hash{};
  std::size_t hashed = 0;  ///< bytes included in `hash`
  std::string digits{};    ///< of the hash of the file, after its end has been read

  std::size_t append(std::string& bytes, std::size_t most) {
    for (; part < parts.size(); ++part)
      if (const std::size_t count = parts[part].append(bytes, most); count > 0) return count;
    if (!parts.empty()) return 0;
    if (held) {
      const std::size_t count = std::min(most, held->size() - next);
      bytes.append(*held, next, count);
      return count;
    }
    const std::size_t before = bytes.size();
    bytes.resize(before + most);
    const ssize_t n = read_some(file.get(), bytes.data() + before, most);
    bytes.resize(before + static_cast<std::size_t>(n > 0 ? n : 0));
    if (n < 0) fail_reading(path);
    return static_cast<std::size_t>(n);
  }

  void add_to_hash(std::string_view bytes) {
    if (!hash || !digits.empty() || next > hashed) return;
    if (bytes.empty() && next == hashed) digits = hash->digits();
    if (next + bytes.size() <= hashed) return;
    hash->add(bytes.substr(hashed - next));
    hashed = next + bytes.size();
  }
};

FileReader::FileReader(const std::string& path) : state_(new State{.path = path}) {
  Descriptor file(path == "-" ? STDIN_FILENO : system::open_to_read(path));
  const auto facts = file.get() < 0 ? std::nullopt : system::facts_of(file.get());
  if (!facts) fail_reading(path);
  if (facts->kind == system::FileKind::folder) {
    errno = EISDIR;
    fail_reading(path);
  }
  const bool regular = facts->kind == system::FileKind::file;
  if (regular) {
    state_->start = ::lseek(file.get(), 0, SEEK_CUR);
    state_->opened = facts;
  }
  state_->file = regular ? std::move(file) : copied(path, file);
  rewind();
}

FileReader::FileReader() : state_(new State) {}

FileReader FileReader::of_bytes(std::string bytes) {
  FileReader reader;
  reader.state_->held = std::move(bytes);
  return reader;
}

FileReader FileReader::joined(std::vector<FileReader> parts) {
  FileReader reader;
  reader.state_->parts = std::move(parts);
  return reader;
}

FileReader::~FileReader() = default;
FileReader::FileReader(FileReader&&) noexcept = default;

std::size_t FileReader::append(std::string& bytes, std::size_t most) {
  const std::size_t before = bytes.size();
  const std::size_t count = state_->append(bytes, most);
  if (most > 0) state_->add_to_hash(std::string_view(bytes).substr(before));
  state_->next += count;
  return count;
}

void FileReader::rewind() {
  state_->next = 0;
  state_->part = 0;
  for (FileReader& part : state_->parts) part.rewind();
  if (state_->held || !state_->parts.empty()) return;
  if (::lseek(state_->file.get(), state_->start, SEEK_SET) < 0) fail_reading(state_->path);
}

void FileReader::refuse_change() const {
  for (const FileReader& part : state_->parts) part.refuse_change();
  if (!state_->opened) return;
  const auto now = system::facts_of(state_->file.get());
  const system::FileFacts& then = *state_->opened;
  if (!now || now->size != then.size || now->written_ns != then.written_ns)
    throw InputError(ErrorKind::transient_io, {state_->path}, "the file was changed while it was read");
}

void FileReader::hash_along() {
  if (!state_->hash) state_->hash.emplace();
}

std::string sha256(FileReader& file) {
  file.hash_along();
  const std::string& digits = file.state_->digits;
  file.rewind();
  if (!digits.empty()) return digits;
  for (std::string bytes; file.append(bytes, portion) > 0;) bytes.clear();
  file.rewind();
  return digits;
}

}  // namespace counterflex
