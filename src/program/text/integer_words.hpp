#pragma once
/// Words without a point, which mean units on some controls and increments on others.
#include <string>
#include <string_view>

#include "counterflex/program/program.hpp"
#include "program/dialect.hpp"

namespace counterflex {

/// Whether the dialect knows both meanings and neither the options nor the machine file choose one.
bool may_doubt_integers(const Program& program, const Dialect& dialect);

/// "X5000 has no point: it may mean units or increments; say which ...". `word` as it stands in the text.
std::string integer_question(std::string_view word);

}  // namespace counterflex
