#pragma once
/// Why a target is outside the travel of an actuator, in words.
#include <string>

#include "counterflex/statics/nominal.hpp"
#include "counterflex/toolpath/toolpath.hpp"

namespace counterflex {

/// A position that is commanded, and what puts it there. Borrowed: everything outlives it.
struct CommandedPlace {
  const Model& model;      ///< with the tool in the spindle
  const WorkFrame& frame;  ///< of the move
  long tool = 0;           ///< its number; 0: none known
  Vector3 target;          ///< in M (m)
};

/// "axis Z: 138.0 mm is outside its travel (-300 to 0 mm): ...", with the parts that make up the value where
/// the axis is parallel to one of the work offset's, and what to do. `named`: the machine without a tool,
/// whose actuators have names.
std::string outside_travel_words(const Mechanism& named, const CommandedPlace& at);

}  // namespace counterflex
