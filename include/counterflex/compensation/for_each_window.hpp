#pragma once
/// Goes through a program while it is read.
#include <functional>

#include "counterflex/program/program_reader.hpp"

namespace counterflex {

/// Calls `first` and then `behind` for all windows of `reader`, each in their order; where there is more than
/// one thread, `behind` looks at a window while up to two later ones are read and `first` looks at them. What
/// it gets is without remarks and path tolerances (`take_window`). Throws what the reader or either of them
/// throws.
void for_each_window(ProgramReader& reader, int threads, const std::function<void(const Program&)>& first,
                     const std::function<void(const Program&)>& behind);

}  // namespace counterflex
