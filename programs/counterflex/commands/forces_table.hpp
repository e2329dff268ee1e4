#pragma once
/// The wrench of every feed move: as a table for people, a document for programs, and a force profile.
#include <map>
#include <string>
#include <string_view>

#include "counterflex/forces/forces.hpp"

namespace counterflex::cli {

/// What the moves add up to; lengths in m.
struct ForceTotals {
  struct Sum {
    std::size_t moves = 0;
    double length = 0;
  };
  Sum with, without;
  std::map<std::string, Sum> why;  ///< those without, by reason
  std::size_t only_z = 0;          ///< moves of which only the force along the tool is known
  std::size_t changing = 0;        ///< moves along which the force is not the same
  double largest_N = 0;
  int largest_line = 0;
};

void add(const MoveForce& move, ForceTotals& totals);

std::string table_head(const std::string& program);
std::string table_row(const MoveForce& move);
std::string table_foot(const ForceTotals& totals);

/// A JSON document in three parts; rows are joined by what `json_row` puts before all but the first.
std::string json_head(const std::string& program);
std::string json_row(const MoveForce& move, bool first);
std::string json_foot(const ForceTotals& totals);

/// How a profile begins that counterflex wrote.
inline constexpr std::string_view profile_mark = "# Forces of ";

/// A profile by path length in the feed frame: rows where a move begins and where its force steps, zeros for
/// one without a force, none for one that a FORCE comment covers. `profile_rows` throws `InputError`
/// (Exit::machine_or_force) where steps in the feed frame cannot say what acts, and (Exit::usage) where a
/// scale, or a bound of the air, makes another force of a comment's.
std::string profile_head(const std::string& program, bool at_platform);
std::string profile_rows(const std::string& program, const MoveForce& move);

}  // namespace counterflex::cli
