#pragma once
/// Where a robot program is divided.
#include "counterflex/program/parts.hpp"
#include "program/robot/line.hpp"

namespace counterflex {

/// A statement that belongs to a part.
struct PartStatement {
  Span span;               ///< whole lines with their ends
  std::size_t points = 0;  ///< targets
  bool may_begin = true;   ///< a part may begin with it
  bool is_rapid = false;
};

/// The index of the first statement of each part. Throws `InputError` at the line of `file` where `most`
/// points do not reach to the next place at which a part may begin.
std::vector<std::size_t> begins_of_parts(const std::string& file, std::string_view text,
                                         const std::vector<PartStatement>& statements, std::size_t most);

/// Throws `InputError`: the statement of `line` cannot be in a part, for the reason `why`.
[[noreturn]] void refuse_part(const std::string& file, const RobotLine& line, std::string_view why);

/// The parts of a program in one of the languages.
std::vector<ProgramPart> divide_tp(const std::string& file, const std::string& text, std::size_t most);
std::vector<ProgramPart> divide_krl(const std::string& file, const std::string& text, std::size_t most);
std::vector<ProgramPart> divide_rapid(const std::string& file, const std::string& text, std::size_t most);
std::vector<ProgramPart> divide_jbi(const std::string& file, const std::string& text, std::size_t most);

/// A text that is the same for a program and its parts: the program with the statements of the parts in the
/// places of their calls. FANUC and Yaskawa: the statements of all jobs, with the contents of positions in
/// the places of their numbers.
std::string joined_tp(const std::string& file, const std::vector<ProgramPart>& parts);
std::string joined_krl(const std::string& file, const std::vector<ProgramPart>& parts);
std::string joined_rapid(const std::string& file, const std::vector<ProgramPart>& parts);
std::string joined_jbi(const std::string& file, const std::vector<ProgramPart>& parts);

}  // namespace counterflex
