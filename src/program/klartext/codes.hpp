#pragma once
/// M words of Klartext.
#include "program/klartext/read.hpp"

namespace counterflex {

/// Effects of the M words of a block.
struct KlartextCodes {
  bool machine_position = false;  ///< M91, M92
  bool cycle_call = false;        ///< M99, M89
  bool calls_each = false;        ///< M89
  bool acts_after = false;        ///< stops, spindle off, coolant off
  bool ends = false;              ///< M2, M30
  bool stops_spindle = false;     ///< at the end of the block
  bool retracts = false;          ///< M140: retracts along the tool at the end of the block
};

/// Reads the M words of the reading and updates its state. Throws `InputError` for a number that is not a
/// code.
KlartextCodes read_klartext_m(const KlartextBlock& block, KlartextReading& reading);

}  // namespace counterflex
