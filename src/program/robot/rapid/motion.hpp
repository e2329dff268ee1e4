#pragma once
/// The arguments of MoveL, MoveC and MoveJ.
#include "program/robot/rapid/statement.hpp"

namespace counterflex {

struct RapidOption {
  std::string name;  ///< in upper case: "WOBJ" of "\WObj:=work"
  Span value;        ///< empty for a switch
};

/// MoveL [\Conc,] target [\ID], speed [\V] [\T], zone [\Z] [\Inpos], tool [\WObj] [\Corr] [\TLoad]; MoveC has
/// two targets.
struct RapidMotion {
  std::vector<Span> targets;
  Span speed, zone, tool;
  std::vector<RapidOption> options;
  bool complete = false;  ///< it has as many arguments as the instruction needs

  const RapidOption* find(std::string_view name) const;
  bool has(std::string_view name) const { return find(name) != nullptr; }
};

RapidMotion rapid_motion(std::string_view text, const RapidStatement& statement);

}  // namespace counterflex
