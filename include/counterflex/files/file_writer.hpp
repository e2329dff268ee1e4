#pragma once
/// Files that appear whole or not at all.
#include <memory>
#include <string>
#include <string_view>

namespace counterflex {

/// A file that is written in order to a temporary name in its folder, and gets its own name when it is
/// published; if it never is, nothing of it stays. Through a symbolic link the file that it names is
/// replaced, with its mode. "-" is standard output: that, pipes and devices are streams, which receive
/// everything at once when they are published. All members throw `InputError` (Exit::transient_io) naming the
/// path where it cannot be written.
class FileWriter {
 public:
  explicit FileWriter(const std::string& path);
  ~FileWriter();
  FileWriter(FileWriter&&) noexcept;

  void write(std::string_view bytes);

  /// Everything is on the disk, the name still the temporary one: for a file, all that is left is to rename
  /// it. A stream has received nothing yet. Nothing can be written any more.
  void complete();

  /// Completes it if need be.
  void publish();

  bool is_stream() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Removes what writers have not published yet, as a program that is interrupted must. Calls nothing that a
/// signal handler may not; no writer may be used afterwards.
void remove_unpublished() noexcept;

}  // namespace counterflex
