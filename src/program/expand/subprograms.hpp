#pragma once
/// The subprograms of a text, and the arguments of their calls.
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "program/evaluate/variables.hpp"
#include "program/expand/call.hpp"
#include "program/expand/definitions.hpp"

namespace counterflex {

/// Finds subprograms by name. A body is read when it is first called.
class Subprograms {
 public:
  /// Without subprograms if calls of the dialect cannot be replaced. Throws `InputError` as
  /// `find_definitions`.
  Subprograms(std::string_view text, const std::string& file, const Dialect& dialect);

  /// How many of them have a number of their own.
  std::ptrdiff_t numbered() const;

  struct Found {
    const Definition* definition = nullptr;  ///< nullptr: the call stays
    std::string why{};                       ///< why it stays
    long repeats = 1;
    bool seeks_numbers = false;  ///< the body, even of a call that stays, has M99 with P
  };

  /// The body that `call` runs. Throws `InputError` as `read_definition`.
  Found find(const SubprogramCall& call);

 private:
  std::string_view text_;
  const std::string& file_;
  const Dialect& dialect_;
  Definitions places_;
  std::map<SubprogramName, Definition> read_{};
};

/// Evaluates the arguments of the call of an O-word with the variables of the caller; missing ones are zero.
/// Returns why they are not known; empty if they are.
std::string evaluate_arguments(const SubprogramCall& call, const Dialect& dialect, const Variables& variables,
                               std::vector<double>& arguments);

}  // namespace counterflex
