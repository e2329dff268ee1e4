#pragma once
/// M words of Klartext.
#include "program/klartext/read.hpp"

namespace counterflex {

/// What the M words of a block do.
struct KlartextCodes {
  bool machine_position = false;  ///< M91, M92
  bool cycle_call = false;        ///< M99, M89
  bool calls_each = false;        ///< M89
  bool acts_after = false;        ///< stops, spindle off, coolant off
  bool ends = false;              ///< M2, M30
  bool retracts = false;          ///< M140: off the part along the tool, at the end of the block
};

/// Reads the M words among the reading's words, and what they do to its state. Throws `InputError` for a
/// number that is no code.
KlartextCodes read_klartext_m(const KlartextBlock& block, KlartextReading& reading);

}  // namespace counterflex
