#pragma once
/// The position data of a Yaskawa job, from //POS to //INST:
///   ///NPOS 2,0,0,1,0,0
///   ///USER 1
///   ///TOOL 2
///   ///POSTYPE USER
///   ///RECTAN
///   ///RCONF 1,0,0,0,0,0
///   C00000=10.000,20.000,30.000,180.0000,0.0000,0.0000
// YASKAWA DX100, "Interface with an Easy Offline Teaching System", 156191-1CD, section 4.1 "Job Data Format";
// NX100, HW0481924, the same section.
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/robot/yaskawa/lex.hpp"

namespace counterflex {

/// The pseudo instructions above a position.
struct JbiSection {
  std::string type{};  ///< of POSTYPE, in upper case; empty without one
  std::optional<long> user{}, tool{};
  bool rectangular = false;  ///< RECTAN, else PULSE
  std::string unknown{};     ///< the first pseudo instruction that is not known

  bool operator==(const JbiSection&) const = default;
};

struct JbiPosition {
  std::size_t line_begin = 0;  ///< byte
  std::uint32_t number = 0;
  std::uint32_t section = 0;
  std::uint32_t uses = 0;  ///< in move instructions
  JbiFamily family = JbiFamily::robot;
  bool computed = false;        ///< an instruction may change it at run time
  bool used_otherwise = false;  ///< by an instruction that is not a move
};

/// The numbers of a position, and the text of its name.
struct JbiValues {
  JbiName name;
  Span text;  ///< behind '=', with the blanks before the first number
  std::vector<RobotNumber> numbers;
};

struct JbiPositions {
  std::vector<JbiSection> sections;
  std::vector<JbiPosition> list;       ///< in the order of the text
  std::vector<std::uint32_t> by_name;  ///< indices into `list`, sorted by family and number
  std::vector<Span> counts;            ///< the numbers of NPOS: of C, BC, EC, P, BP, EX
  std::size_t end = 0;                 ///< byte behind the line //INST

  const JbiPosition* find(JbiFamily family, std::uint32_t number) const;
  JbiPosition* find(JbiFamily family, std::uint32_t number);
};

/// Reads the positions of a job. Throws `InputError` in `file` for a position that is not one.
JbiPositions jbi_positions(std::string_view text, const std::string& file);

/// The numbers of the position whose line begins at byte `line_begin`. Empty for other text.
std::optional<JbiValues> jbi_values(std::string_view text, std::size_t line_begin);

/// The number of the line that has byte `at`, from 1.
int jbi_line_number(std::string_view text, std::size_t at);

}  // namespace counterflex
