#pragma once
/// The best work offsets and tool data of a program: predict --offsets.
#include <string>
#include <vector>

#include "counterflex/compensation/constant_shift.hpp"
#include "counterflex/report/offset_words.hpp"
#include "counterflex/report/report.hpp"
#include "process/console.hpp"
#include "run/run.hpp"

namespace counterflex::cli {

/// Collects the deviations of a prediction, and then solves the program with shifted offsets. Keeps a
/// reference to the run.
class OffsetSearch {
 public:
  /// Throws `InputError` (ErrorKind::machine_or_force) for a machine that does not control x, y and z, and if
  /// the value of a work offset in use is not given.
  explicit OffsetSearch(Run& run);
  OffsetSearch(const OffsetSearch&) = delete;
  OffsetSearch& operator=(const OffsetSearch&) = delete;

  /// The next waypoints of the prediction.
  void add(const Job& window, const std::vector<Waypoint>& waypoints);

  /// After a prediction without a failure, with its report and tally. Throws `InputError` at a place that is
  /// not solved with the shift, and (ErrorKind::program_text) if no feed move was solved.
  BestOffsets find(const Options& options, const RunReport& report, const RunTally& before, Console& console);

 private:
  /// A work offset that the program uses.
  struct Offset {
    std::string name;
    Pose X_MW;                                  ///< now
    bool is_set = false;                        ///< by the program itself
    bool is_touched = false, is_stated = true;  ///< its datum
  };

  /// Of the last pass: what the shift leaves.
  struct Rest {
    RunTally tally;
    DeviationTally holes{};
  };

  std::optional<Failure> pass(const ConstantShift& shift, ShiftPlaces& found, Rest* rest,
                              Console& console) const;
  Vector3 zero_of_control(const std::string& offset) const;
  BestShift written(const ControlWords& control, const BestShift& best, BestOffsets& result) const;
  std::vector<std::string> notes(const BestShift& best) const;
  bool is_enough(const RunTally& tally) const;

  Run& run_;
  std::vector<Offset> offsets_;
  ShiftFreedom freedom_;
  ShiftPlaces first_;
  DeviationTally first_holes_;
};

}  // namespace counterflex::cli
