#pragma once
/// Programs of machines that do not mill, and of controls whose programs are not read: recognised so that the error
/// names them.
#include <string>
#include <string_view>

namespace counterflex {

/// What the program is, and by what it shows: "a lathe program (G96 and no Y)". Empty where nothing shows. `text` is
/// its beginning.
std::string other_machine(std::string_view text);

}  // namespace counterflex
