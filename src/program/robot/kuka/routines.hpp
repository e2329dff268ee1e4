#pragma once
/// What the routines of a KRL file do where they are called, and which variables the text changes in places
/// that the reader does not follow.
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "counterflex/program/read_program.hpp"
#include "program/robot/kuka/lex.hpp"

namespace counterflex {

/// A routine, with all that it calls in the same file.
struct KrlRoutine {
  bool moves = false;          ///< it moves the robot, or calls what may do so
  bool cuts = false;           ///< it has linear or circular motions
  bool calls_unread = false;   ///< it calls a routine of another file
  bool selects_frame = false;  ///< $BASE, or a call of BAS that may set it
  bool selects_tool = false;
  bool sets_speed = false;        ///< $VEL, or a call of BAS that may set it
  bool sets_turns = false;        ///< $ORI_TYPE, or a call of BAS that may set it
  bool sets_circle = false;       ///< $CIRC_TYPE
  bool acts = false;              ///< it does more than set speeds
  std::vector<bool> is_input{};   ///< by parameter: IN; the routine may change others
  std::set<std::string> calls{};  ///< in upper case
};

struct KrlFacts {
  std::map<std::string, KrlRoutine, std::less<>> routines{};  ///< by name in upper case
  /// Variables that another routine than the first, an index that is computed, or a call may change, with the
  /// line. "P[3]" is one element, "P" all of an array; without members.
  std::map<std::string, int, std::less<>> changed{};

  /// The routine of that name in upper case; null for one of another file.
  const KrlRoutine* find(std::string_view name) const;

  /// The line that may change the variable, its array or its element; 0 without one.
  int changed_in(std::string_view variable) const;
};

/// Scans the routines of a file, in portions of whole lines. Data lists have no routines.
class KrlScan {
 public:
  /// `names`: routines of other files that neither move the robot nor change its state.
  explicit KrlScan(const CallNames& names) : harmless_(names) {}
  void add(std::string_view lines);
  KrlFacts finish();

 private:
  void add_statement(std::string_view text, const RobotLine& line);
  void begin_routine(std::string_view text, const RobotLine& line);
  void add_calls(std::string_view text, const RobotLine& line);
  void add_change(std::string_view variable, int line);
  void add_argument(const std::string& callee, std::size_t index, std::string_view argument, int line);
  bool is_local(std::string_view variable) const;
  KrlRoutine called(const std::string& name) const;
  void close_over_calls();

  /// A variable that is the argument of a call, with its line.
  struct Argument {
    std::string callee;
    std::size_t index = 0;
    std::string variable;
    bool operator<(const Argument& other) const {
      return std::tie(callee, index, variable) < std::tie(other.callee, other.index, other.variable);
    }
  };

  const CallNames& harmless_;
  KrlFacts facts_;
  std::map<Argument, int> arguments_;
  std::set<std::string, std::less<>> locals_;  ///< of the routine under way: declared, or its parameters
  KrlRoutine* routine_ = nullptr;
  bool is_first_ = true;
  int line_ = 0;
};

/// The facts of a text, up to its data lists.
KrlFacts krl_facts_of(std::string_view text);

/// Whether "NAME(" begins the statement: a call. BAS selects frames and speeds, but does not move the robot.
bool is_krl_call(std::string_view text, const RobotLine& line);

/// Whether a call of that function of the control does not move the robot. `name` is in upper case.
bool is_motionless_call(std::string_view name);

/// "name(argument, argument)" in a statement.
struct KrlCall {
  Span name;
  std::string word;                    ///< the name in upper case
  std::vector<std::string> arguments;  ///< in upper case without blanks
};

/// The calls in the statement of `line`, also those in expressions and behind TRIGGER and INTERRUPT. BAS is
/// not among them.
std::vector<KrlCall> krl_calls(std::string_view text, const RobotLine& line);

/// Whether a function of the control writes what it reads to that variable of the control, $BASE or $TOOL.
bool reads_into(const KrlCall& call, std::string_view variable);

/// Whether a statement may be run more often without another effect: it sets speeds, or is a condition. Calls
/// are not judged.
bool may_repeat(std::string_view text, const RobotLine& line);

/// The variable without its members: "P[3]" of "P[3].X"; "P" of "P[n].X" and "P[]", whose element is not
/// known.
std::string changed_part(std::string_view variable);

}  // namespace counterflex
