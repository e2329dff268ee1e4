#pragma once
/// The dialect that the text of a program shows.
#include <string_view>

#include "program/dialect.hpp"

namespace counterflex {

/// What "auto" means for `text`: heidenhain where it begins with BEGIN PGM, fanuc where the first line that
/// says anything holds an O-number, siemens where there are words that only a Sinumerik reads, else linuxcnc.
const Dialect& detect_dialect(std::string_view text);

}  // namespace counterflex
