#pragma once
/// Reads a machining program.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "counterflex/files/input_error.hpp"
#include "counterflex/program/program.hpp"

namespace counterflex {

struct ReadOptions {
  /// auto, linuxcnc, grbl, fanuc, haas, mach3, siemens, heidenhain. auto looks at the first megabyte: BEGIN
  /// PGM means heidenhain, words of its language siemens, an O-number or a name behind '%' fanuc, or haas or
  /// mach3 where only they know all codes; else linuxcnc, or mach3 where only that does, or grbl that a
  /// comment names.
  std::string dialect = "auto";
  std::optional<LengthUnit> unit;  ///< where the program does not say before its first move
  std::optional<std::vector<char>>
      tool_change_moves;  ///< axes of "XYZ" unknown after a tool change; none: the
                          ///< dialect's, no axis for linuxcnc and grbl, else all
  IntegerWords integer_words = IntegerWords::unsaid;
  bool absolute_centres = false;  ///< I, J, K of arcs are coordinates, until the program says otherwise (G91.1)
  std::map<long, double> tool_lengths_mm{};  ///< by H, or the active tool's number where G43 has no H: with
                                             ///< both lengths known Z stays known when they change
  bool evaluate = false;  ///< variables that the program sets to constants, and expressions of them, are their values
  bool expand_subprograms =
      false;  ///< calls by M98, CALL LBL and O-words with plain numbers become the bodies' text
};

/// A dialect in which programs are not read (Exit::usage).
class UnknownDialect : public InputError {
 public:
  using InputError::InputError;
};

/// What is wrong with `ReadOptions::dialect`; nothing where programs are read in it.
std::optional<std::string> unknown_dialect(const std::string& dialect);

/// Reads `text`, keeping every byte. `file` names it in diagnostics. Throws `InputError` with line and column
/// for text that is wrong and for words that are not understood yet (Exit::program_text;
/// Exit::machine_or_force for a FORCE comment): nothing is passed over. A dialect that does not exist is
/// `UnknownDialect`.
Program read_program(std::string text, const std::string& file, const ReadOptions& options);

/// The first word without a point in the moves up to `line` that may mean units or increments, and the question which;
/// none where that is known.
std::optional<Remark> integer_word_in_doubt(const Program& window, int line);

/// Whether the header of a corrected program stands in `text` (a comment that begins "COUNTERFLEX 1").
bool is_corrected(const Program& program);

}  // namespace counterflex
