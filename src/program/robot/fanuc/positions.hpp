#pragma once
/// The list of positions of a FANUC TP program (/POS), and what statements need from lines far from them.
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/robot/fanuc/lex.hpp"
#include "program/robot/target.hpp"

namespace counterflex {

/// P[3]{ ... };
struct TpPosition {
  Span span;
  int line = 0;                ///< of its first byte
  std::uint32_t uses = 0;      ///< in statements of /MN
  std::uint32_t followed = 0;  ///< of these, the uses as targets of moves that are followed
};
using TpPositions = std::map<long, TpPosition>;

/// A whole program.
struct TpFile {
  TpPositions positions;
  bool computed_index = false;                  ///< a statement uses P[R[1]]: any position may be meant
  bool numbered = false;                        ///< the numbers of the lines of /MN increase
  std::optional<Span> line_count{};             ///< the number of LINE_COUNT, if it is that of the last line
  std::map<std::optional<long>, int> frames{};  ///< line of the last UFRAME[n]=...; empty: of any n
  int first_jump = 0;                           ///< line of the first jump to a label; 0: none
  int last_call = 0;                            ///< line of the last statement of `tp_calls`; 0: none
};

/// Reads the lines of `text` without the statements. Throws `InputError` for a list of positions that is not
/// complete, and for a position that is defined twice.
TpFile tp_file(const std::string& file, std::string_view text);

/// The number of "LINE_COUNT = 8;" in a line of /ATTR. Empty for other lines.
std::optional<Span> line_count_in(std::string_view text, Span line);

/// The content of a position.
struct TpPoint {
  std::optional<long> frame{}, tool{};            ///< UF, UT; empty for F: those that are selected
  std::string configuration{};                    ///< CONFIG, without blanks
  RobotTarget target{};                           ///< of group 1; E1 to E3 are external axes
  bool joint = false;                             ///< group 1 has joint angles
  std::array<std::optional<double>, 9> joints{};  ///< J1 to J9, deg; J7 to J9 are external axes
  std::vector<double> other_groups{};             ///< numbers of the other groups
};

/// Reads a position. Throws `InputError` at text that is not a position.
TpPoint tp_point(const std::string& file, std::string_view text, const TpPosition& position);

}  // namespace counterflex
