#pragma once
/// Loops over the elements of an array, whose targets are in a data list:
///   FOR n = 1 TO 100
///     LIN POINTS[n] C_DIS
///   ENDFOR
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/files/file_reader.hpp"
#include "program/robot/kuka/lex.hpp"

namespace counterflex {

struct KrlLoop {
  RobotLine motion;    ///< the line of LIN
  std::string array;   ///< its name in upper case
  std::string member;  ///< of the element, in upper case; empty: the element is the target
  long first = 0, last = 0;
  Span last_number;         ///< of `last`
  bool sets_speed = false;  ///< a statement may change the speed
  bool sets_zone = false;   ///< a statement may change $APO
  /// More passes would do something else: a statement uses the counter, in the loop or outside, or acts once
  /// in each pass.
  bool acts = false;
  std::vector<std::string> assigned{};  ///< variables in upper case
  std::size_t end = 0;                  ///< byte behind the line of ENDFOR
};

/// The loop whose FOR is in `line`, if it runs one linear motion for each element of an array and changes
/// neither frame nor tool nor a target. `text` has the whole program. Throws `InputError` in `file` at a
/// statement that changes an element.
std::optional<KrlLoop> loop_over_array(std::string_view text, const std::string& file, const RobotLine& line);

/// Where a program may be cut so that its data list follows the loop that uses it.
struct KrlCut {
  std::size_t at = 0;  ///< byte behind the line of ENDFOR
  int line = 0;        ///< that begins there
};

/// Empty if the program is not as `join_files_by_motion` requires. Reads `list` to its end.
std::optional<KrlCut> cut_behind_loop(std::string_view program, FileReader& list);

/// The element of an array that a statement assigns, with a number as its index: "P[3] = {X 1}".
struct KrlElement {
  std::string array;  ///< its name in upper case
  long index = 0;
  Span index_text;  ///< between the brackets
  Span value;
};
std::optional<KrlElement> element_in(std::string_view text, const RobotLine& line);

/// The plain whole number that is the whole of `span`, which may have blanks around it.
std::optional<long> whole_number(std::string_view text, Span span);

/// The size of an array in its declaration: "DECL GLOBAL FRAME POINTS[779]". Empty in other lines.
std::optional<Span> declared_size(std::string_view text, const RobotLine& line, std::string_view array);

/// The byte at which the first data list of a joined text begins: its line "&FILE NAME". The size of the text
/// without one.
std::size_t data_list_at(std::string_view text);

/// The number of the line behind a mark of a list that follows its loop.
std::optional<int> number_behind_mark(std::string_view code);

/// The elements of an array that a text assigns.
struct KrlArray {
  long first = 0, last = 0;
  bool in_order = true;  ///< each index is the one before plus 1
};
using KrlArrays = std::map<std::string, KrlArray, std::less<>>;

/// Adds the elements that `lines` assign.
void add_elements(std::string_view lines, KrlArrays& arrays);

/// Counts the elements of an array on through the windows of a program: a target that was inserted has the
/// index of the one behind it.
struct KrlNumbering {
  std::string array;           ///< in upper case
  std::optional<long> next{};  ///< index of the next element; empty before the first

  std::string numbered(std::string lines);
};

/// The array of a loop that a data list follows, if its FOR is in `window`.
std::optional<KrlNumbering> numbering_in(std::string_view window);

/// The text of a program after points were inserted: the indices of arrays with loops count on, and the sizes
/// of these arrays and the ends of their loops change with them.
std::string with_counted_arrays(std::string text, const std::string& file);

}  // namespace counterflex
