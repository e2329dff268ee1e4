#pragma once
/// Which routines of an ABB RAPID module do not move the robot.
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/program/read_program.hpp"
#include "program/robot/rapid/statement.hpp"

namespace counterflex {

using RapidNames = std::set<std::string, std::less<>>;  ///< in upper case

/// Finds the routines of a module that neither move the robot nor set how motions run, also in the routines
/// of the module that they call. The statements of the module are added in order.
class StillRoutines {
 public:
  /// `names`: routines of other modules that neither move the robot nor change its state.
  explicit StillRoutines(const CallNames& names) : harmless_(names) {}
  void add(std::string_view text, const RapidStatement& statement);

  /// The names of these routines.
  RapidNames finish() const;

  /// The names of all routines.
  RapidNames all() const;

 private:
  struct Body {
    bool moves = false;
    RapidNames instructions{};  ///< the first names of its calls
    RapidNames names{};         ///< all names in its statements: some may be routines that it calls
    RapidNames functions{};     ///< that its expressions call
  };

  bool may_be_still(const Body& body) const;

  const CallNames& harmless_;
  std::map<std::string, Body, std::less<>> bodies_{};  ///< by name of the routine
  Body* body_ = nullptr;                               ///< of the last statement; null: outside of routines
  bool ended_ = false;                                 ///< behind ENDMODULE
};

/// The name of the routine that `statement` begins, in upper case. Empty for TRAP, which is not called.
std::string name_of_routine(std::string_view text, const RapidStatement& statement);

/// Whether a bracket behind that word is not the begin of arguments: AND, FROM. `name` is in upper case.
bool is_word_before_bracket(std::string_view name);

/// The names of functions that the expressions of `statement` call; of "IF condition statement;" those of the
/// condition.
std::vector<Span> rapid_functions(std::string_view text, const RapidStatement& statement);

/// Calls `visit` with the names in [at, end) that may be data or routines: not members or options.
template <typename Visit>
void visit_rapid_names(std::string_view text, std::size_t at, std::size_t end, const Visit& visit) {
  RapidToken before;
  for (;;) {
    const RapidToken token = rapid_token_at(text, at, end);
    if (token.kind == RapidTokenKind::none) return;
    const bool is_part = is_symbol(text, before, '.') || is_symbol(text, before, '\\');
    if (token.kind == RapidTokenKind::name && !is_part) visit(token.span);
    before = token;
    at = token.span.end;
  }
}

}  // namespace counterflex
