#pragma once
/// Which data the statements of ABB RAPID change.
#include "program/robot/rapid/module.hpp"

namespace counterflex {

/// Whether parameters of the routine that `statement` begins have INOUT, VAR or PERS.
bool has_reference_parameters(std::string_view text, const RapidStatement& statement);

/// The names of data that `statement` may change: the variable of an assignment, and the arguments of
/// instructions, routines and functions that are not known to only read them. `routines` are those of the
/// module. Of "IF condition statement;" the condition is read alone.
std::vector<Span> names_changed_by(std::string_view text, const RapidStatement& statement,
                                   const RapidRoutines& routines);

}  // namespace counterflex
