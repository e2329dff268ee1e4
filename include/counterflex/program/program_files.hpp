#pragma once
/// Programs that consist of several files: a program of a KUKA robot and its data lists.
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/files/input_error.hpp"

namespace counterflex {

/// Whether a program with that name may have data lists: NAME.src.
bool takes_data_lists(const std::string& program);

/// The data list NAME.dat beside the program NAME.src, with any case of the extensions. Empty if there is
/// none.
std::string data_list_beside(const std::string& program);

/// The bytes of all files as one text, which `read_program` reads. Before each file but the first is a line
/// "&FILE NAME". Throws `InputError` as FileReader does, and ErrorKind::usage if a file has such a line.
FileReader join_files(const std::vector<std::string>& paths);

/// The same with the data list behind the loop that uses it, so that the text has the targets in the order of
/// the motion and is read in windows. Empty if the program is not of this kind: one list, one loop over an
/// array of all of its targets, no other named targets, no subprograms, less than 200 kB without the list.
std::optional<FileReader> join_files_by_motion(const std::vector<std::string>& paths);

/// What a corrected program of that kind has in its loop and in its list.
struct LoopCount {
  std::string array;  ///< in upper case
  long last = 0;      ///< index of its last element
};

/// The array of the loop of a program, without elements.
LoopCount loop_count_of(std::string_view program);

/// Adds the elements in whole lines of the list.
void add_elements(std::string_view lines, LoopCount& count);

/// The program with the end of its loop, and lines of the list with the size of the array.
std::string with_loop_end(std::string program, const LoopCount& count);
std::string with_array_size(std::string lines, const LoopCount& count);

/// Where the lines of joined files are: the first line of each file in the joined text.
std::vector<int> first_lines(const std::vector<std::string>& paths);

/// The place of `line` of a joined text in its file.
Location place_in_files(const std::vector<std::string>& paths, const std::vector<int>& first, int line);

/// Divides a joined text, which may be a corrected one, into its files again.
class FileSplitter {
 public:
  /// `write` receives bytes of a file, by its index.
  explicit FileSplitter(std::function<void(std::size_t file, std::string_view bytes)> write);

  /// Adds whole lines of the text.
  void add(std::string_view lines);

  /// Call it once, after the last line.
  void finish();

 private:
  void write(std::string_view bytes);

  std::function<void(std::size_t, std::string_view)> write_;
  std::size_t file_ = 0;
  bool holds_newline_ = false;  ///< it may belong to the line of the next file
};

}  // namespace counterflex
