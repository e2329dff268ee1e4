#pragma once
/// Which data the statements of ABB RAPID change, and which routines do not move the robot.
#include "program/robot/rapid/module.hpp"

namespace counterflex {

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

/// The name of the routine that `statement` begins, in upper case. Empty for TRAP, which is not called.
std::string name_of_routine(std::string_view text, const RapidStatement& statement);

/// Whether parameters of the routine that `statement` begins have INOUT, VAR or PERS.
bool has_reference_parameters(std::string_view text, const RapidStatement& statement);

/// The names of data that `statement` may change: the variable of an assignment, and the arguments of
/// instructions, routines and functions that are not known to only read them. `routines` are those of the
/// module. Of "IF condition statement;" the condition is read alone.
std::vector<Span> names_changed_by(std::string_view text, const RapidStatement& statement,
                                   const RapidRoutines& routines);

/// Sets `still` of the routines of a module. Its statements are added in order.
class StillRoutines {
 public:
  explicit StillRoutines(RapidRoutines& routines) : routines_(routines) {}
  void add(std::string_view text, const RapidStatement& statement);
  void finish();

 private:
  RapidRoutines& routines_;
  std::string routine_;                                    ///< of the last statement
  std::map<std::string, std::set<std::string>> called_{};  ///< by routine
};

}  // namespace counterflex
