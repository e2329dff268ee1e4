#pragma once
/// Guards of FANUC TP.
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/program/guard.hpp"

namespace counterflex {

/// IF with ABORT. Each statement is behind a remark with its mark.
std::vector<std::string> tp_guard(const Guard& guard);
std::string why_no_tp_guard(const Guard& guard);

/// Whether the line before the statement at byte `begin` of `text` is the mark of `statement`.
bool is_tp_guard_statement(std::string_view text, std::size_t begin, std::string_view statement);

/// The same of the line at byte `begin`.
bool is_tp_guard_line(std::string_view text, std::size_t begin);

}  // namespace counterflex
