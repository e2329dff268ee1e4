#pragma once
/// Words without a decimal point, which mean units on some controls and increments on others.
#include <string>
#include <string_view>

#include "counterflex/program/program.hpp"
#include "program/dialect.hpp"

namespace counterflex {

/// Whether the dialect allows both meanings and neither the options nor the machine file select one.
bool integers_may_be_ambiguous(const Program& program, const Dialect& dialect);

/// "X5000 has no decimal point: it may mean units or increments; give ...". `word` as it is in the text.
std::string integer_question(std::string_view word);

}  // namespace counterflex
