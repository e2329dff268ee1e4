#pragma once
/// Data that an ABB RAPID module declares: targets, tools, work objects, speeds, zones.
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "program/robot/rapid/routines.hpp"

namespace counterflex {

struct RapidDatum {
  std::string type;   ///< in upper case; empty for a parameter of a routine
  std::string name;   ///< as it is declared
  std::string value;  ///< text behind ":="; empty for a target
  Span span;          ///< of that text
  bool constant = false;
  bool array = false;
  int computed_in = 0;   ///< line of a statement that may change it at run time; 0: not computed
  std::size_t uses = 0;  ///< number of tokens with its name, without its declaration
};

struct RapidRoutine {
  bool writes_arguments = false;  ///< it has parameters with INOUT, VAR or PERS
};
using RapidRoutines = std::map<std::string, RapidRoutine, std::less<>>;  ///< by name in upper case

class RapidModule {
 public:
  RapidModule() = default;

  /// A module that is not scanned, with the names of its routines and of those that do not move the robot.
  RapidModule(const RapidNames& routines, RapidNames still);

  /// Adds the declaration, the parameters or the routine that `statement` begins.
  void declare(std::string_view text, const RapidStatement& statement);

  /// Adds all declarations and uses of a whole module.
  void scan(std::string_view text, const CallNames& harmless);

  /// The datum with that name (any case) for a statement at byte `at`: of its routine, else of the module.
  const RapidDatum* find(std::string_view name, std::size_t at) const;

  /// Whether the module has an instruction with that name in upper case.
  bool calls(std::string_view name) const { return calls_.contains(name); }

  /// Whether the module has a routine with that name in upper case.
  bool has_routine(std::string_view name) const { return routines_.contains(name); }

  /// Whether the module has a routine with that name in upper case that does not move the robot.
  bool has_still_routine(std::string_view name) const { return still_.contains(name); }

 private:
  void add_uses(std::string_view text, const RapidStatement& statement, int line);
  void add_changes(std::string_view text, const RapidStatement& statement, int line);
  void add_parameters(std::string_view text, const RapidStatement& statement);
  std::size_t routine_at(std::size_t at) const;
  std::string key_of(std::string_view name, std::size_t at) const;

  std::map<std::string, RapidDatum, std::less<>> data_;  ///< by name in upper case and number of the routine
  std::set<std::string, std::less<>> calls_;
  RapidRoutines routines_;
  RapidNames still_;
  struct Section {
    std::size_t begin, routine;  ///< number of the routine from 1, 0: outside of routines
  };
  std::vector<Section> sections_;
  std::size_t routine_count_ = 0;
};

/// Whether the statements of a module may depend on lines far away from them, so that it is read as a whole,
/// and what the others need from far lines. Lines are added in portions.
class RapidScan {
 public:
  explicit RapidScan(const CallNames& names) : still_(names) {}
  void add(std::string_view lines);
  bool depends_on_far_lines() const { return far_; }

  /// Of a module that is not read as a whole: its routines, and those that do not move the robot.
  RapidNames routines() const { return still_.all(); }
  RapidNames still_routines() const { return still_.finish(); }

 private:
  StillRoutines still_;
  bool far_ = false;
  bool in_routines_ = false;
};

/// The same for a whole text.
bool rapid_depends_on_far_lines(std::string_view text);

/// Instructions of the control that do not move the robot, by name in upper case.
bool is_motionless_instruction(std::string_view name);

/// Functions of the control that do not move the robot, by name in upper case.
bool is_motionless_function(std::string_view name);

/// Instructions that set how the motions behind them run.
bool is_mode_instruction(std::string_view name);

/// Instructions and functions of the control that do not change their arguments. False for a name that is not
/// known. Options with a result are changed by all instructions: see `is_option_with_result`.
bool only_reads(std::string_view name);
bool is_option_with_result(std::string_view name);

/// Motions of the tool to a target, and of the joints.
bool is_linear_instruction(std::string_view name);
bool is_joint_instruction(std::string_view name);

}  // namespace counterflex
