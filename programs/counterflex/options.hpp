#pragma once
/// What the command line says, as plain data. Texts that need a file to make sense of them stay texts.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "counterflex/batch/shards.hpp"
#include "counterflex/compensation/options.hpp"
#include "counterflex/program/program.hpp"
#include "counterflex/settings/setting.hpp"

namespace counterflex::cli {

enum class Command { compensate, predict, verify, compare, analyze, forces, check, batch, watch };

/// Where settings come from besides jobs files.
struct SettingSources {
  std::vector<Setting> flags, environment;
  std::optional<std::string> config;  ///< the project file that --config names
  bool no_config = false;             ///< no project file is looked for
};

/// A warning about a setting.
struct SettingRemark {
  Location where;
  std::string what;
};

struct Options {
  Command command = Command::check;

  std::string program;               ///< verify: the original
  std::string corrected;             ///< verify alone
  std::vector<std::string> files;    ///< check alone
  std::vector<std::string> reports;  ///< compare alone: two
  std::vector<std::string> names;    ///< of these, or none
  std::string machine;               ///< empty: none, which check and forces alone allow

  std::vector<std::string> forces;     ///< files
  std::vector<ForceRule> force_rules;  ///< of --force
  std::optional<Vector6> force;        ///< analyze alone (N, N m)
  double load_scale = 1;
  double blend = 2e-3;  ///< m
  std::optional<double> air_above_mm;

  std::optional<std::string> dialect;
  std::optional<LengthUnit> units;
  IntegerWords integer_words = IntegerWords::unsaid;
  std::optional<bool> absolute_centres;  ///< of arcs; none: the machine file's, or incremental
  bool evaluate = false;
  bool expand_subprograms = false;
  std::vector<std::string> work;           ///< "G54=X,Y,Z[,RX,RY,RZ][/DATUM]", or "machine"
  std::optional<std::string> tool_table;   ///< a file
  std::map<long, double> tool_lengths_mm;  ///< of --tool-length
  std::vector<std::string> at;             ///< "X,Y,Z[,R,P,Y]"
  std::optional<std::string> tool;         ///< "T3"
  bool full = false;                       ///< analyze alone: details of every chain
  std::optional<std::string> hold;         ///< analyze alone: "X,Y,Z[,R,P,Y]"
  std::optional<std::string> curve;        ///< analyze alone: "DIRECTION=FROM:TO:STEPS"

  Method method = Method::direct;
  double tolerance = 5e-6;               ///< m
  std::optional<double> max_correction;  ///< m; none: the machine file's
  bool accept_partial = false;           ///< a program is written though the verdict is PARTLY
  int decimals = -1;                     ///< -1: each word's own
  bool number_pieces = false;
  int threads = 1;
  double min_block_ms = 2;

  std::optional<std::string> output;
  std::vector<std::string> folders;   ///< of outputs: made before anything is written, if they are missing
  bool materials = false;             ///< forces alone
  std::optional<std::string> report;  ///< stem
  std::optional<std::string> plot;    ///< a file
  bool force_overwrite = false;       ///< replace files that this program did not write

  std::string jobs;            ///< batch alone, as all that follows: the jobs file
  bool resume = false;         ///< what is proven done is not done again
  std::optional<Shard> shard;  ///< only its jobs
  bool merge = false;          ///< what the shards have done
  bool estimate = false;       ///< say how long it would take

  std::string folder;                 ///< watch alone, as what follows
  std::vector<std::string> patterns;  ///< what names of programs match; none: any
  bool once = false;                  ///< what is there, and no more

  bool hash_outputs = false;  ///< compensate alone, of a batch: for its manifest

  bool json = false;
  bool quiet = false;
  bool verbose = false;
  SettingSources sources;    ///< what this command line, and the environment, say of them
  std::string project_file;  ///< from which settings are, too; empty: none
  bool print_config = false;
  std::vector<SettingRemark> remarks;  ///< on what is said for this run
};

}  // namespace counterflex::cli
