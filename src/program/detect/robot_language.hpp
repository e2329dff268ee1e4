#pragma once
/// Recognises robot programs, so that the error can name the language.
#include <string_view>

namespace counterflex {

/// "KUKA KRL", "ABB RAPID", "FANUC TP (LS)", "URScript", "Yaskawa INFORM (JBI)", "APT"; empty for any other
/// text. The first line that is neither empty nor a comment decides.
std::string_view robot_language(std::string_view text);

}  // namespace counterflex
