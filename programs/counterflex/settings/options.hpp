#pragma once
/// The options of a run as plain data. Values that need a file to be interpreted stay texts.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "counterflex/batch/manifest.hpp"
#include "counterflex/compensation/options.hpp"
#include "counterflex/program/program.hpp"
#include "counterflex/settings/project_file.hpp"

namespace counterflex::cli {

enum class Command {
  compensate,
  predict,
  verify,
  compare,
  analyze,
  forces,
  check,
  create,
  import,
  identify,
  testcut,
  map,
  batch,
  watch
};

/// Sources of settings besides jobs files.
struct SettingSources {
  std::vector<Setting> flags, environment;
  std::optional<std::string> config;  ///< the project file of --config
  bool no_config = false;             ///< no project file is searched
};

/// A warning about a setting.
struct SettingRemark {
  Location where;
  std::string what;
};

/// Of `check`.
struct CheckOptions {
  std::vector<std::string> files;
  bool parameters = false;          ///< list the parameters of a machine file
  std::optional<std::string> draw;  ///< an SVG file
};

/// Of `new`. Texts of the command line.
struct NewOptions {
  std::string kind;
  bool robots = false;  ///< list the robots that are known
  std::string name;
  std::optional<std::string> travel, squareness, tip_stiffness, pivot, robot, nodes, home, leg_stiffness, arm,
      radius;
};

struct PredictOptions {
  bool offsets = false;  ///< find the best work offsets and tool data
};

struct VerifyOptions {
  std::string corrected;  ///< the corrected program
};

struct CompareOptions {
  std::vector<std::string> reports;  ///< two
  std::vector<std::string> names;    ///< of the reports; may be empty
};

struct ForcesOptions {
  bool materials = false;          ///< list the materials whose coefficients are known
  bool fit = false;                ///< identify coefficients
  std::optional<std::string> log;  ///< of the spindle, a file
};

struct AnalyzeOptions {
  std::vector<std::string> at;       ///< "X,Y,Z[,R,P,Y]"
  std::vector<std::string> joints;   ///< "J1,J2,...": shown values, mm or deg
  std::vector<std::string> poses;    ///< "X,Y,Z,A,B,C": in the numbers of `as`
  std::optional<std::string> as;     ///< "kuka", "fanuc", "abb" or "ur"
  std::optional<std::string> tool;   ///< "T3"
  std::optional<Vector6> force;      ///< N, N m
  bool full = false;                 ///< details of every chain
  std::optional<std::string> hold;   ///< "X,Y,Z[,R,P,Y]"
  std::optional<std::string> curve;  ///< "DIRECTION=FROM:TO:STEPS"
};

/// Of `map`. Texts of the command line.
struct MapOptions {
  bool stiffness = false, deviation = false;  ///< neither: stiffness
  std::optional<std::string> direction, box, grid, rpy, tool;
  std::optional<Vector6> force;     ///< N, N m
  std::optional<std::string> plot;  ///< an SVG file
};

struct IdentifyOptionTexts {
  std::vector<std::string> data;        ///< measurement files
  std::optional<std::string> fit;       ///< "zeros,geometry"
  std::optional<std::string> hold_out;  ///< "session", "region" or "20%"
  bool all = false;                     ///< keep sets that do not improve held-out rows
  std::string prior;                    ///< file of an earlier covariance; or empty
  std::string program;                  ///< whose deviations are to be known better; or empty
};

/// Of `testcut`. Texts of the command line.
struct TestcutOptions {
  std::optional<std::string> box, tool, sheet;
  std::optional<std::string> diameter, feed, speed;  ///< mm, mm/min, 1/min
};

struct ImportOptions {
  std::string source;  ///< "urdf", ...: what the file is
  std::string file;
  std::optional<std::string> base, tip;   ///< links of a URDF
  std::optional<std::string> convention;  ///< of a DH table
  std::optional<std::string> format;      ///< of volumetric compensation
  bool negate = false;                    ///< the file has what the control adds, not the errors
};

struct BatchOptions {
  std::string jobs;            ///< the jobs file
  bool resume = false;         ///< skip jobs whose outputs match the manifest
  std::optional<Shard> shard;  ///< only its jobs
  bool merge = false;          ///< sum up what the shards have done
  bool estimate = false;       ///< print how long the batch would take
};

struct WatchOptions {
  std::string folder;
  std::vector<std::string> patterns;  ///< that names of programs match; empty: any
  bool once = false;                  ///< the programs that are there, and no more
};

class JobFiles;

/// Options of every command that uses them; those of a single command are in its own struct.
struct Options {
  Command command = Command::check;

  std::string program;  ///< verify: the original
  std::string machine;  ///< may be empty for check and forces only

  std::vector<std::string> forces;     ///< files
  std::vector<ForceRule> force_rules;  ///< of --force
  bool shares_forces = false;          ///< they are those of a file for several programs
  double load_scale = 1;
  double blend = 2e-3;  ///< m
  std::optional<double> air_above_mm;

  std::optional<std::string> dialect;
  std::optional<LengthUnit> units;
  IntegerWords integer_words = IntegerWords::unspecified;
  std::optional<bool> absolute_centres;  ///< of arcs; unset: as in the machine file, or incremental
  bool evaluate = false;
  bool expand_subprograms = false;
  std::vector<std::string> data_lists;     ///< of a KUKA program: files
  std::vector<std::string> work;           ///< "G54=X,Y,Z[,RX,RY,RZ][/DATUM]", or "machine"
  std::optional<std::string> tool_table;   ///< a file
  std::map<long, double> tool_lengths_mm;  ///< of --tool-length
  std::optional<double> temperature;       ///< degrees Celsius
  std::optional<std::string> uncertainty;  ///< a file
  std::size_t samples = 0;                 ///< of machines, for bands; 0: to first order alone

  Method method = Method::direct;
  double tolerance = 5e-6;               ///< m
  double tilt_tolerance = 0.02 * deg;    ///< rad
  std::optional<double> spin_tolerance;  ///< rad; unset: any
  bool free_spin = false;                ///< the turn about the spindle axis is chosen
  std::optional<double> max_correction;  ///< m; unset: that of the machine file
  bool only_significant = false;         ///< targets below their bands stay as programmed
  bool accept_partial = false;           ///< a program is written though the verdict is PARTLY
  int decimals = -1;                     ///< -1: as in each word
  bool number_pieces = false;
  std::optional<std::size_t> max_points;  ///< of a robot program
  bool guard = false;                     ///< write checks before the first cut
  bool proof = false;                     ///< add the setup sheet to the page of the report
  int threads = 1;
  double min_block_ms = 2;

  std::optional<std::string> output;
  std::vector<std::string> folders;   ///< of outputs: made before anything is written, if they are missing
  std::optional<std::string> report;  ///< stem
  std::optional<std::string> plot;    ///< a file
  bool force_overwrite = false;       ///< replace files that counterflex did not write

  CheckOptions check;
  NewOptions create;
  PredictOptions predict;
  VerifyOptions verify;
  CompareOptions compare;
  ForcesOptions forces_table;
  AnalyzeOptions analyze;
  MapOptions map;
  IdentifyOptionTexts identify;
  TestcutOptions testcut;
  ImportOptions import;
  BatchOptions batch;
  WatchOptions watch;

  bool hash_outputs = false;            ///< compensate in a batch only: for its manifest
  const JobFiles* job_files = nullptr;  ///< compensate in a batch or a watch only: of all jobs

  bool json = false;
  bool without_causes = false;  ///< compensate in Python only: waypoints have no causes
  bool quiet = false;
  bool verbose = false;
  SettingSources sources;    ///< settings of this command line and the environment
  std::string project_file;  ///< path of the project file that was read, or empty
  bool print_config = false;
  std::vector<SettingRemark> remarks;  ///< on settings of this run
};

}  // namespace counterflex::cli
