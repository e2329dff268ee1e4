#pragma once
/// Meanings of G and M codes on a Sinumerik.
#include "program/gcode/words/codes.hpp"

namespace counterflex {

/// The code `tenths`, or nullptr.
const GCode* find_siemens_code(int tenths);

MAction action_of_siemens_m(int code);

}  // namespace counterflex
