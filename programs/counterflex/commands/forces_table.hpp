#pragma once
/// The wrench of every feed move, as a text table, a JSON document and a force profile.
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "counterflex/forces/forces.hpp"

namespace counterflex::cli {

/// Sums over the moves; lengths in m.
struct ForceTotals {
  struct Sum {
    std::size_t moves = 0;
    std::size_t unknown = 0;  ///< of them: the length is not known
    double length = 0;        ///< of the others
  };
  Sum with, without;
  std::map<std::string, Sum> why;  ///< moves without a force, by reason
  std::size_t only_z = 0;          ///< moves of which only the force along the tool is known
  std::size_t changing = 0;        ///< moves along which the force changes
  double largest_N = 0;
  int largest_line = 0;
};

void add(const MoveForce& move, ForceTotals& totals);

/// `at_platform`: where the wrenches are, at the reference point or at the tip.
std::string table_head(const std::string& program, bool at_platform);
std::string table_row(const MoveForce& move);
std::string table_foot(const ForceTotals& totals);

/// A JSON document in three parts: begin, rows, end. `json_row` adds the separator before all rows except the
/// first.
std::string json_head(const std::string& program, bool at_platform);
std::string json_row(const MoveForce& move, bool first);
std::string json_foot(const ForceTotals& totals);

/// Where a profile has come: what the next rows need of those before.
struct ProfileEnd {
  std::optional<std::string> axial;  ///< fz and mz; empty text: nothing acts. None: there is no move yet
  int turn_line = 0;                 ///< of a block that only turns the tool after the last row; 0: none
};

/// First text of profiles written by counterflex.
inline constexpr std::string_view profile_mark = "# Forces of ";

/// A profile by path length in the feed frame. Rows are at starts of moves and at steps of the force. Moves
/// without a force have zeros, moves under a FORCE comment have nothing. A block that only turns the tool has
/// no row: it takes the axial part of the row before or after it. `profile_rows` throws `InputError`:
/// ErrorKind::machine_or_force if steps in the feed frame cannot represent the force, ErrorKind::usage if
/// --load-scale or --air-above would change the force of a comment.
std::string profile_head(const std::string& program, bool at_platform);
std::string profile_rows(const std::string& program, const MoveForce& move, ProfileEnd& end);

}  // namespace counterflex::cli
