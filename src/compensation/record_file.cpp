#include "record_file.hpp"

#include <utility>

#include "counterflex/files/bytes.hpp"
#include "counterflex/files/input_error.hpp"

namespace counterflex {
namespace {

constexpr std::string_view format_line = "counterflex-part 1\n";
constexpr std::uint32_t order_of_bytes = 0x01020304;
constexpr std::size_t bytes_at_once = 1 << 18, digits_of_hash = 64;

[[noreturn]] void refuse_record(const std::string& path, const std::string& what) {
  throw InputError(Exit::machine_or_force, {path}, what);
}

[[noreturn]] void refuse_damage(const std::string& path) {
  refuse_record(path, "the recorded part of a program is damaged; compensate the part again");
}

std::string header_of_records(const std::string& run) {
  std::string bytes(format_line);
  put(order_of_bytes, bytes);
  put(std::string_view(run), bytes);
  return bytes;
}

// Hashes all but the digits at the end, which it returns.
std::string hash_to_digits(FileReader& file, Sha256& hash) {
  std::string bytes;
  while (file.append(bytes, bytes_at_once) > 0) {
    if (bytes.size() <= digits_of_hash) continue;
    const std::size_t hashed = bytes.size() - digits_of_hash;
    hash.add(std::string_view(bytes).substr(0, hashed));
    bytes.erase(0, hashed);
  }
  return bytes;
}

}  // namespace

RecordWriter::RecordWriter(const std::string& path, const std::string& run) : file_(path) {
  write(header_of_records(run));
}

void RecordWriter::write(std::string_view bytes) {
  hash_.add(bytes);
  file_.write(bytes);
}

void RecordWriter::add(std::string_view record) {
  std::string length;
  put(record.size(), length);
  write(length);
  write(record);
}

FileWriter RecordWriter::finish() {
  add({});
  file_.write(hash_.digits());
  return std::move(file_);
}

void check_record_file(const std::string& path, const std::string& run) {
  FileReader file(path);
  std::string begin;
  const std::string header = header_of_records(run);
  while (begin.size() < header.size() && file.append(begin, header.size() - begin.size()) > 0) {
  }
  if (!begin.starts_with(format_line))
    refuse_record(path, "is not a recorded part of a program (counterflex-part 1)");
  file.rewind();
  Sha256 hash;
  const std::string digits = hash_to_digits(file, hash);
  if (digits != hash.digits()) refuse_damage(path);
  if (begin != header) refuse_record(path, "was recorded in another run, with other files or options");
}

RecordReader::RecordReader(const std::string& path, const std::string& run) : path_(path), file_(path) {
  const std::string header = header_of_records(run);
  if (take(header.size()) != header) refuse_damage(path_);
}

std::string RecordReader::take(std::size_t count) {
  if (count > file_.size()) refuse_damage(path_);
  if (ahead_.size() - begin_ < count) {
    ahead_.erase(0, std::exchange(begin_, 0));
    while (ahead_.size() < count && file_.append(ahead_, bytes_at_once) > 0) {
    }
    if (ahead_.size() < count) refuse_damage(path_);
  }
  std::string taken = ahead_.substr(begin_, count);
  begin_ += count;
  return taken;
}

std::optional<std::string> RecordReader::next() {
  const std::string bytes = take(sizeof(std::size_t));
  const auto length = BytesIn(bytes).get<std::size_t>();
  if (length == 0) return std::nullopt;
  return take(length);
}

}  // namespace counterflex
