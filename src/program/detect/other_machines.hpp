#pragma once
/// Recognises programs of other machines, such as lathes, and of controls that are not supported, so that the
/// error can name them.
#include <string>
#include <string_view>

namespace counterflex {

/// The kind of program and the signs of it: "a lathe program (G96 and no Y)". Empty if there are no such
/// signs. `text` is the beginning of the program.
std::string other_machine(std::string_view text);

}  // namespace counterflex
