#pragma once
/// Words of a Sinumerik that set a feed or a speed by name.
#include "program/gcode/interpret.hpp"

namespace counterflex {

/// Applies S1=, M1=, FB=, FZ=, OVR=, SVC=, SETMS and SPOS= of the sorted block. A value that is not known
/// makes its feed or speed unknown. So does a word of a numbered spindle, unless SETMS has set the main
/// spindle.
void apply_speed_words(const Block& block, Reading& reading);

/// A feed and a speed of a block whose words are not read are unknown.
void forget_unread_speeds(const Block& block, ModalState& state);

}  // namespace counterflex
