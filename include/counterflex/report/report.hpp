#pragma once
/// What a run did, measured: all values in the report's JSON and the summary on the terminal. Lengths
/// in mm, angles in degrees, as reports show them.
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "counterflex/compensation/uncertainty.hpp"
#include "counterflex/compensation/windows.hpp"
#include "counterflex/machine/machine.hpp"
#include "counterflex/program/boxed_optional.hpp"
#include "counterflex/program/overview.hpp"
#include "counterflex/program/restart.hpp"
#include "counterflex/report/path_curves.hpp"
#include "counterflex/report/statistics.hpp"
#include "counterflex/sanity/checks.hpp"

namespace counterflex {

enum class Command { compensate, predict, verify };

/// A file that the run read. `name` is its role: "program", "machine", "forces", "corrected".
struct InputFile {
  std::string name;
  std::string path;
  std::string sha256;
};

struct OptionValue {
  std::string name;  ///< as on the command line, without the dashes
  std::variant<bool, double, std::string> value;
};

/// The checks before the first cut of the written program.
struct WrittenGuard {
  Guard guard;
  int line = 0;            ///< of the original: the block before which they are
  std::size_t places = 0;  ///< at which the corners of the window were solved
};

/// What the setup sheet of a written program states besides its report (see `proof_sheet`).
struct ProofFacts {
  /// A work offset of the program.
  struct Offset {
    std::string work;                    ///< name; empty: program coordinates are M
    Vector3 place_mm = Vector3::Zero();  ///< of its origin, in M
    Vector3 rpy_deg = Vector3::Zero();   ///< of its axes, in M
    std::optional<Vector3> shown_mm{};   ///< the numbers on the control; none: not known
  };
  /// A tool of the program.
  struct Tool {
    long number = 0;  ///< 0: none known
    std::optional<double> length_mm{}, radius_mm{};
    std::vector<std::string> forces;  ///< where the force on it comes from, in words; empty: no force
  };
  std::string serial, date;  ///< of the machine file; empty: not stated
  std::vector<Offset> offsets;
  /// By how much each work offset may be off; none: not even by the smallest of `window_steps_mm`.
  std::optional<double> window_mm{};
  std::size_t window_places = 0;  ///< at which it was solved
  bool window_lengths = false;    ///< the lengths of tools that bend may be off, too
  bool window_turns = false;      ///< and the angles of the frames: by `guarded_angle_deg`
  std::vector<Tool> tools;
  RestartLines restart;
  std::size_t solved_places = 0;   ///< at which the machine was solved forward with the written program
  std::vector<InputFile> written;  ///< the corrected program first
};

/// What the rotation about the spindle buys (--free spin), before correction.
struct FreeSpin {
  double programmed_mm = 0;  ///< largest deviation of feed moves as programmed
  int programmed_line = 0;
  double turned_mm = 0;  ///< of the turned program; the same where nothing is turned
  int turned_line = 0;
  std::size_t targets = 0, turned = 0;  ///< of the program, and those that are turned
  double least_deg = 0, most_deg = 0;   ///< turn of the targets, counter-clockwise about the spindle axis
};

/// What stays as programmed because the deviation is below its own band (--only-significant). It is read from
/// the written text: a target without a correction counts.
struct AsProgrammed {
  std::size_t targets = 0, left = 0;  ///< ends of moves that were solved; of them without a correction
  double length_mm = 0, left_mm = 0;  ///< of feed moves; of them without a correction from end to end
  double largest_mm = 0,
         band_mm = 0;    ///< largest deviation of feed moves and holes that is left, and its band
  int largest_line = 0;  ///< 0: nothing is left
};

/// What only the caller of a run knows. Inputs and options keep their order in the report.
struct RunFacts {
  std::string version;  ///< of the tool
  std::vector<InputFile> inputs;
  std::vector<OptionValue> options;
  /// Besides the program's remarks and the forces' notes, which are added here.
  std::vector<Remark> warnings;
  std::string output;           ///< path of the corrected program; empty: no program is written
  bool accept_partial = false;  ///< PARTLY does not count as a failure
  double min_block_ms = 2;      ///< what takes less time is a short block
  /// The waypoints' geometry, load, superposition, air, higher and lower were solved.
  bool attribution = false;
  std::optional<WrittenGuard> guard{};
  std::optional<ProofFacts> proof{};  ///< with --proof, if a program is written
  std::optional<FreeSpin> free_spin{};
};

/// Where a line's largest deviation is.
struct WorstPlace {
  bool known = false;
  std::optional<double> band_mm{};     ///< of the deviation, k = 2
  double s_mm = 0;                     ///< cutting path length
  Vector3 place_mm = Vector3::Zero();  ///< wanted tip in M
  std::int32_t operation = -1;         ///< index into RunReport::operations; -1: not known
  double force_N = 0;                  ///< acting there
  int corrected_line = 0;              ///< of the corrected program; 0: none
};

/// The sizes of what a deviation is made of: norms, in mm.
struct DeviationParts {
  double geometry_mm = 0, load_mm = 0, fixture_mm = 0, gravity_mm = 0;
  double discrepancy_mm = 0;  ///< of the deviation from the superposition of its causes
  double preloads_mm = 0;
};

struct WorstRow {
  int line = 0;
  double before_mm = 0;
  double after_mm = 0;
  WorstPlace at_before, at_after;
  std::optional<DeviationParts> causes;  ///< of `before_mm`, where they were asked for
  std::string text{};                    ///< the program's line, see `add_texts`
};

/// Something largest, and the line of the original program where it is.
struct Largest {
  double mm = 0;
  int line = 0;
};

/// Where the deviation before is largest: what each source has in it there (axes of M).
struct SourcesAtWorst {
  int line = 0;
  Vector3 place_mm = Vector3::Zero();  ///< wanted tip in M
  Vector3 geometry_mm = Vector3::Zero(), load_mm = Vector3::Zero(), fixture_mm = Vector3::Zero(),
          gravity_mm = Vector3::Zero(), preloads_mm = Vector3::Zero();
  Vector3 superposition_mm = Vector3::Zero();  ///< sum of these
  Vector3 before_mm = Vector3::Zero();
};

/// Of a waypoint with causes.
SourcesAtWorst sources_at(const Waypoint& w, const Causes& causes);

/// Where each part of the deviation before comes from.
struct Sources {
  std::optional<DeviationStatistics> geometry, load;
  std::optional<DeviationStatistics> fixture;   ///< none for a machine without a fixture
  std::optional<DeviationStatistics> gravity;   ///< none for a machine without masses
  std::optional<DeviationStatistics> preloads;  ///< none where preloads move nothing
  DeviationStatistics superposition;
};

/// Places at which the causes are not known: with one of them alone the machine has no stable equilibrium.
struct UnknownCauses {
  std::size_t places = 0;
  int first_line = 0;
};

/// The deviation under a force that is higher or lower by `force_change`. Places where the machine has no
/// stable equilibrium are in `unsolved` alone.
struct UnderOtherForce {
  DeviationStatistics deviation;
  std::size_t unsolved = 0;
  int first_line = 0;  ///< of the unsolved
  Status status = Status::converged;
};

/// What the deviation of the corrected program (`predict`: of the original one) becomes when the force is
/// another.
struct Sensitivity {
  UnderOtherForce higher, lower;
  DeviationStatistics without;
};

/// The deviation before that touching off would remove, where no datum is stated.
struct CommonShift {
  struct OfOffset {
    std::string work;  ///< name of the offset; empty: program coordinates are M
    Vector3 shift_mm = Vector3::Zero();
  };
  std::vector<OfOffset> offsets;
  DeviationStatistics rest;  ///< the deviation before without it

  double largest_mm() const;
};

/// The constant shifts of work offsets, tool lengths and cutter radii that leave the least deviation.
struct BestOffsets {
  /// What is added to the values that the control has.
  struct OfWork {
    std::string work;                    ///< name of the offset
    Vector3 shift_mm = Vector3::Zero();  ///< of its origin, axes of M
    std::optional<Vector3> turn_deg{};   ///< of its axes: rotation vector, axes of M; none: not turned
    std::string change;                  ///< shift and turn for people: "X-0.041 Y0.012 mm"
    std::vector<std::string> words;      ///< the new value in the control's words, a line each
    double before_mm = 0, rest_mm = 0;   ///< largest deviation of its feed moves, and what the shifts leave
  };
  struct OfTool {
    long tool = 0;
    std::optional<double> length_mm{}, radius_mm{};  ///< none: not changed
    std::vector<std::string> words;                  ///< a line each; empty: the control has none
  };
  std::vector<OfWork> work;  ///< those of feed moves
  std::vector<OfTool> tools;
  DeviationStatistics before, rest;  ///< of all feed moves; `rest` with the written, rounded values
  double least_mm = 0;               ///< the largest deviation before the values are rounded
  std::size_t passes = 0;            ///< over the program with a shift in effect
  bool is_enough = false;            ///< every feed move is within the tolerances with the shifts
  std::vector<std::string> notes;    ///< what was not changed, and why
};

/// What a tool of the program does at its tip, rim and flank.
struct ToolReport {
  ToolSize size;
  std::optional<ToolDeviation> before, after;
};

struct ForceSummary {
  double largest_N = 0;      ///< force acting on a feed move
  double largest_Nm = 0;     ///< and moment, as it is stated: see `at_platform`
  bool at_platform = false;  ///< forces and moments are those at the reference point instead of the tip
  std::size_t ramps = 0;     ///< steps of the profile that act as ramps
  std::size_t jumps = 0;     ///< steps that act as steps
  double largest_step_N = 0;
  WithoutForce without;
};

struct BlockCounts {
  std::size_t total = 0;             ///< of the original program: lines with a word
  std::size_t moves = 0;             ///< of these, moves
  std::size_t corrected = 0;         ///< moves that are corrected each on its own
  std::optional<OtherMoves> others;  ///< the treatment of the others; for `compensate` alone
  std::size_t inserted = 0;          ///< blocks added
  Capped<LeftAlone> left_alone;
  Capped<LeftAlone> machine_positions;  ///< blocks in machine coordinates; they are not moves
};

/// The moves of one tool in one operation.
struct OperationReport {
  long tool = 0;                      ///< in the spindle; 0: none known
  std::string name;                   ///< title, see Program::operation_titles; empty: none
  int first_line = 0, last_line = 0;  ///< the least and the largest of its feed moves
  std::size_t moves = 0;              ///< feed moves
  double length_mm = 0;
  std::optional<double> corrected_percent;           ///< of the length, as for the run
  std::optional<DeviationStatistics> before, after;  ///< none where nothing was solved
};

/// How uncertain the deviations are. Bands have k = 2.
struct UncertaintyReport {
  Uncertainty stated;
  std::size_t known_parameters = 0, parameters = 0;  ///< those without a deviation count as exact
  /// Where the deviation before is largest (mm): the bands of its parts, and of all of them.
  struct AtWorst {
    double parameters_mm = 0, force_mm = 0, others_mm = 0, all_mm = 0;
  };
  std::optional<AtWorst> at_worst{};
  std::optional<SampledBands> sampled{};  ///< with --samples
};

/// Size of the program text.
struct TextSize {
  std::size_t blocks = 0;
  std::size_t bytes = 0;
};

/// Feed moves that take less than `limit_ms` at programmed feeds; lines of the program that has them.
struct ShortBlocks {
  double limit_ms = 0;
  std::size_t count = 0;
  int first_line = 0;
  double shortest_ms = 0;
  int shortest_line = 0;
};

/// What a control may make of a program.
struct ControlFacts {
  std::optional<ShortBlocks> short_blocks;  ///< of the corrected program; empty without such a program
  std::optional<LineLengths> lines;         ///< likewise
  Zones zones;                              ///< of the corrected program, or of the original without it
  std::vector<PathTolerance> tolerances;    ///< of the original
  std::size_t plunges = 0;                  ///< feed moves of the original straight down in Z
  std::size_t rapids = 0;                   ///< and its rapids
};

/// A tool of the program for which the machine file has data.
struct UsedTool {
  long number = 0;
  std::optional<double> length_mm;
  std::optional<double> radial_N_per_um;  ///< at its tip; none: rigid
  std::string stiffness;                  ///< where that is from, in words
};

/// An axis with lost motion reverses in a move.
struct ReversalRow {
  int line = 0;
  std::string axis;
};

/// Lengths as the people of a program and a machine have them.
struct ShownUnits {
  LengthUnit program = LengthUnit::millimetres;
  bool revolute = false;  ///< the machine turns a joint: its deviations are shown in mm, not in µm
};

struct RunReport {
  Command command = Command::compensate;
  Verdict verdict = Verdict::failed;
  std::string verdict_reason;  ///< the text behind the word; empty for OK
  /// Why the run does not succeed; none: it is done, and only then is a program written.
  std::optional<ErrorKind> error_kind = ErrorKind::internal;
  int exit_status = 0;  ///< of the process, for `error_kind`; filled by the caller, who defines the numbers
  FeedMoves feed_moves;
  RunFacts facts;  ///< its `warnings` stay the caller's own; all are in `warnings` below
  std::string machine;
  std::string unmeasured{};  ///< "UNMEASURED: ..."; empty unless no stiffness of the machine is measured
  Method method = Method::direct;
  double tolerance_mm = 0;
  double path_mm = 0;                         ///< length of the feed moves
  std::optional<DeviationStatistics> before;  ///< none where a run failed before anything was solved
  std::optional<DeviationStatistics> after;   ///< model residual; none for `predict`, and like `before`
  std::optional<Sources> sources;             ///< with attribution
  std::optional<SourcesAtWorst> at_worst;     ///< where `before` is largest, if the causes are known there
  UnknownCauses without_causes;               ///< where they were asked for
  std::optional<Sensitivity> sensitivity;     ///< where a force acts
  /// Largest deviation of a feed move of the corrected program without the force.
  std::optional<Largest> air;
  std::optional<CommonShift> common_shift;    ///< none: all datums are stated, or nothing was solved
  std::optional<BestOffsets> best_offsets{};  ///< if they were requested
  std::vector<ToolReport> tools_off;          ///< tools of feed moves, the largest deviation first
  std::optional<Largest> correction;          ///< largest change of a target
  /// Of `path_mm`: the part that is corrected, within the tolerance.
  std::optional<double> corrected_percent;
  /// In the order in which they are met; of many the last one represents all others.
  std::vector<OperationReport> operations;
  ShownUnits units;
  BlockCounts blocks;
  TextSize text_before;
  std::optional<TextSize> text_after;
  ControlFacts control;
  ForceSummary forces;
  std::optional<Capped<ReversalRow>> reversals{};  ///< where axes have lost motion
  std::optional<PathLoads> loads{};                ///< where they were solved, see `add_loads`
  std::optional<UncertaintyReport> uncertainty{};  ///< for a machine that states one
  std::optional<AsProgrammed> as_programmed{};     ///< with --only-significant
  Capped<Remark> warnings;
  std::vector<WorstRow> worst;  ///< at most ten lines, the largest `after` first (`before` for `predict`)
  std::string work;             ///< where program coordinates were taken to be, in words
  std::string datum;            ///< what the offset was taken to mean, in words
  std::vector<UsedTool> tools;  ///< where a tool of the program makes the machine another one
  std::string tools_assumed;    ///< their stiffness in words; empty without any
  std::string gravity;          ///< which weights were taken to act, in words; empty without any
  std::optional<double> temperature_C{};  ///< of the machine, where it is given
  std::string thermal;  ///< the shift by temperature in words; empty for a machine without a table
  std::vector<std::string> already_corrected;  ///< by the control, as the machine file states
  std::vector<std::string> not_modelled;       ///< what else moves the tip of a real machine, one phrase each
  SanityChecks sanity{};                       ///< filled by the caller, who knows the machine's model
  std::optional<Failure> failure;
  std::optional<SourcesAtWorst> failure_place{};  ///< where the original program is off most in its line
};

/// What a report is about besides what was measured. Borrowed: everything outlives it.
struct RunContext {
  const Machine& machine;
  const CompensationOptions& options;
  const std::vector<WorkFrame>& frames;  ///< by index into the program's work offsets
  const Overview& program;               ///< the original one, after `ignore_axes`
  const RunFacts& facts;
};

/// Adds the loads along the run's path, and a warning for every limit of `machine` that they exceed.
void add_loads(RunReport& report, LoadsAlong along, const Machine& machine);

/// What is known of the uncertainty where `worst` has the largest deviation before; `covariance` there.
UncertaintyReport uncertainty_report(const Machine& machine, const LoadPlace* worst,
                                     const std::optional<TipCovariance>& covariance);

/// Fills what `places` become under the other forces of a sensitivity, and warns where the machine has no
/// stable equilibrium. `higher`, `lower`: by place.
void add_sensitivity(RunReport& report, const std::vector<LoadPlace>& places,
                     const std::vector<OtherForce>& higher, const std::vector<OtherForce>& lower);

/// The sensitivity of a run without attribution: also without the force it is solved at `places` only.
void add_sensitivity(RunReport& report, const std::vector<LoadPlace>& places,
                     const std::vector<OtherForce>& higher, const std::vector<OtherForce>& lower,
                     const std::vector<OtherForce>& without);

/// Why a run without a failure of its own ends with another status than `done`: the verdict, and what to do.
std::optional<Failure> refusal_of(const RunReport& report);

class RunTally;
class FileReader;

/// Fills in the texts of the worst lines, cut to 200 bytes, from the original program's bytes: they are read
/// to the last of these lines. Throws as `FileReader` does.
void add_texts(RunReport& report, FileReader& program);

/// The report of a run whose waypoints, forces and texts `tally` has: those of the original program
/// (`predict`), or of the corrected one; a run that failed may have any part of them. `corrected` is the
/// program that was verified. Never throws; allocates.
RunReport report_prediction(const RunContext& context, const RunTally& tally,
                            const std::optional<Failure>& failure);
RunReport report_compensation(const RunContext& context, const RunTally& tally,
                              const std::optional<Failure>& failure);
RunReport report_verification(const RunContext& context, const RunTally& tally, const Overview& corrected,
                              const std::optional<Failure>& failure);

// Reports that earlier runs have written, read back.

/// A run's report, as text, and what its page shows besides.
struct ReportFile {
  std::string name;     ///< of the run, for people: the file's stem
  std::string path;     ///< as it was given
  std::string sha256;   ///< of that file
  std::string report;   ///< "counterflex-report 1", JSON
  std::string curves;   ///< JSON, as the page's data has it; empty: none
  std::string loads;    ///< likewise
  std::string machine;  ///< likewise
  std::string source;   ///< likewise
  std::string remark;   ///< why there are no curves though they were asked for; empty: nothing to remark
};

enum class WithCurves { no, yes };

/// Reads STEM.json, or STEM.html with the report in it; "-" is standard input, with JSON. Curves and loads of
/// STEM.json are those of STEM.html beside it, where that page shows the same report. Throws `InputError`
/// (ErrorKind::usage) where the file cannot be read, at line and column where it is not JSON, and where it is
/// another document than the report of one run.
ReportFile read_report_file(const std::string& path, WithCurves with);

/// Gives two runs of the same name different ones: folders before it as far as these differ, else numbers
/// behind it.
void tell_apart(ReportFile& a, ReportFile& b);

/// The page beside `path`, STEM.html of STEM.json; empty where `path` has another ending.
std::string page_beside(const std::string& path);

}  // namespace counterflex
