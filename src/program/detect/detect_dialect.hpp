#pragma once
/// Detects the dialect of a program from its text.
#include <string_view>

#include "program/dialect.hpp"

namespace counterflex {

/// The dialect of `text` for "auto": heidenhain if it begins with BEGIN PGM, fanuc if the first line with
/// words has an O-number, siemens if it has words that only a Sinumerik reads, else linuxcnc.
const Dialect& detect_dialect(std::string_view text);

}  // namespace counterflex
