#pragma once
/// What the command line says, as plain data. Texts that need a file to make sense of them stay texts.
#include <optional>
#include <string>
#include <vector>

#include "counterflex/compensation/options.hpp"
#include "counterflex/program/program.hpp"

namespace counterflex::cli {

enum class Command { compensate, predict, verify, compare, analyze, forces, check, watch };

struct Options {
  Command command = Command::check;

  std::string program;                ///< verify: the original
  std::string corrected;              ///< verify alone
  std::vector<std::string> files;     ///< check alone
  std::vector<std::string> reports;   ///< compare alone: two
  std::vector<std::string> names;     ///< of these, or none
  std::string folder;                 ///< watch alone
  std::vector<std::string> patterns;  ///< watch alone: what names of programs match; none: any
  bool once = false;                  ///< watch alone: what is there, and no more
  std::string machine;                ///< empty: none, which check and forces alone allow

  std::vector<std::string> forces;     ///< files
  std::vector<ForceRule> force_rules;  ///< of --force
  std::optional<Vector6> force;        ///< analyze alone (N, N m)
  double load_scale = 1;
  double blend = 2e-3;  ///< m
  std::optional<double> air_above_mm;

  std::optional<std::string> dialect;
  std::optional<LengthUnit> units;
  IntegerWords integer_words = IntegerWords::unsaid;
  bool expand_subprograms = false;
  std::vector<std::string> work;          ///< "G54=X,Y,Z[,RX,RY,RZ]"
  std::optional<std::string> tool_table;  ///< a file
  std::vector<std::string> at;            ///< "X,Y,Z[,R,P,Y]"
  std::optional<std::string> tool;        ///< "T3"

  Method method = Method::direct;
  double tolerance = 5e-6;               ///< m
  std::optional<double> max_correction;  ///< m; none: the machine file's
  int decimals = -1;                     ///< -1: each word's own
  int threads = 1;
  double min_block_ms = 2;

  std::optional<std::string> output;
  bool materials = false;             ///< forces alone
  std::optional<std::string> report;  ///< stem
  std::optional<std::string> plot;    ///< a file
  bool json = false;
  bool quiet = false;
  bool verbose = false;
};

}  // namespace counterflex::cli
