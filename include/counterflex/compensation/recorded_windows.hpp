#pragma once
/// A long program in parts: each part is compensated by a process of its own, which records its windows; a
/// run that has these records takes them over. What comes out is the same to the byte: a record answers for
/// the state in which its window was entered and for no other; where it is another, the window is
/// compensated.
#include <memory>
#include <string>
#include <vector>

#include "counterflex/compensation/compensate_windows.hpp"
#include "counterflex/files/file_writer.hpp"

namespace counterflex {

/// The windows of a program that begin at `bytes` of its text. To record them a run has to know in which
/// state those before them leave the text: `last_words` are the bytes where they have said each axis last.
struct RecordedPart {
  Span bytes;
  std::array<std::optional<std::size_t>, 3> last_words{};
};

/// Compensates the windows of `part` and writes what comes of them
/// to `file`: all of them, or all before the first that fails, which is left to the run that takes them over,
/// with its error. For windows before the part only what is cheap is done: they are read, and the machine
/// follows them; the last of them is compensated to come near to the state in which they leave the text.
/// Windows behind the part are not read. `run` says what decides the results, files and options. `events`
/// hear of windows before the part only that they were read. The file is the same for any number of threads;
/// it has everything but its name, which the caller gives it when it knows that no input has changed. Throws
/// `InputError` where the program or its forces can no longer be read, or the file cannot be written.
FileWriter record_windows(JobWindows& windows, const CompensationOptions& options, TextReader corrected,
                          bool attribution, const RecordedPart& part, const std::string& run,
                          const std::string& file, const WindowEvents& events);

/// The records of a run. A million blocks need some hundred megabytes: they are read when it is their turn.
class RecordedWindows {
 public:
  /// Looks through all `files`, in any order; some windows may be in none. Throws `InputError`
  /// (Exit::machine_or_force), naming the file, where one is damaged or of another run than `run`.
  RecordedWindows(const std::vector<std::string>& files, const std::string& run);
  ~RecordedWindows();

  /// Of the windows so far: how many were taken over.
  std::size_t taken() const;
  /// And how many were compensated.
  std::size_t compensated() const;

  struct Impl;
  Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// As `compensate_windows`, to the byte and to the last bit of every number; takes over what is recorded.
std::optional<Failure> compensate_windows(JobWindows& windows, const CompensationOptions& options,
                                          TextReader corrected, bool attribution, const WindowEvents& events,
                                          RecordedWindows& recorded);

}  // namespace counterflex
