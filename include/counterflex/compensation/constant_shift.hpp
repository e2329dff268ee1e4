#pragma once
/// Constant shifts of what is entered at the control: work offsets, tool lengths and radii of cutters. The
/// wanted path stays where it is, and all commands move. The best shift leaves the least largest deviation.
/// Lengths in m, angles in rad.
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "counterflex/compensation/windows.hpp"

namespace counterflex {

/// What is added to the values of the control.
struct ConstantShift {
  /// By index into Program::frames: the command X in M becomes frames[i] * X. Empty: no frame moves.
  std::vector<Pose> frames{};
  std::map<long, double> lengths{};  ///< by tool: with a longer one the control stays further back
  std::map<long, double> radii{};    ///< by tool: with a larger one it stays further from contours
};

/// Solves the original program forward with `shift` in effect: `after` of the waypoints is their deviation
/// from the path that is wanted without it. Nothing else is solved. As `predict_windows` otherwise.
std::optional<Failure> predict_shifted_windows(JobWindows& windows, int threads, const ConstantShift& shift,
                                               const WindowEvents& events);

/// What may be shifted.
struct ShiftFreedom {
  std::vector<std::size_t> offset_of_frame{};  ///< by index into Program::frames: number of its work offset
  std::size_t offsets = 0;                     ///< how many there are
  bool turns = false;                          ///< offsets are turned, too
  bool lengths = false;                        ///< tools after the first one of an offset get lengths
};

/// A place of a feed move or of a cycle (`is_place_of_cycle`), and what its command depends on.
struct ShiftPlace {
  std::size_t number = 0;  ///< of its waypoint among those that are taken, from the beginning
  int line = 0;
  TipPosition wanted;
  Vector3 command = Vector3::Zero();  ///< of the original program
  Vector6 F = Vector6::Zero();
  Directions directions{};
  std::size_t frame = 0;
  long tool = 0;
  Vector3 away = Vector3::Zero();  ///< motion of the command by the radius: unit, axes of M; zero: none
  Vector3 deviation = Vector3::Zero();
};

/// Takes the waypoints of feed moves and cycles in their order, and keeps a bounded number of them: the
/// largest deviation for each work offset, tool, direction of the deviation, direction away from a contour
/// and part of the workspace; and places all along the path. Where the program is cut into windows changes
/// nothing.
class ShiftPlaces {
 public:
  explicit ShiftPlaces(const ShiftFreedom& freedom) : freedom_(&freedom) {}

  /// Adds `after` of waypoints. The job's models outlive what is kept.
  void add(const Job& job, const std::vector<Waypoint>& waypoints);

  /// Each once, in order.
  std::vector<ShiftPlace> places() const;

  double largest(std::size_t offset) const;                  ///< deviation of an offset; 0 without places
  bool has(std::size_t offset) const;                        ///< whether a feed move uses it
  const std::vector<long>& tools() const { return tools_; }  ///< in the order of their first feed moves
  const std::set<std::pair<std::size_t, long>>& pairs() const { return pairs_; }  ///< offset and tool
  const std::set<long>& contours() const { return contours_; }                    ///< tools beside a contour
  bool at_platform() const { return at_platform_; }

  /// The smallest box around the wanted places of an offset.
  struct Box {
    Vector3 least = Vector3::Constant(HUGE_VAL), most = Vector3::Constant(-HUGE_VAL);
  };
  Box box(std::size_t offset) const;

 private:
  using Stratum = std::array<long, 3>;
  void keep(const ShiftPlace& place, std::size_t offset);
  void sample(const ShiftPlace& place);

  const ShiftFreedom* freedom_;
  std::map<Stratum, ShiftPlace> strata_;
  std::vector<ShiftPlace> samples_;
  std::size_t spacing_ = 1, count_ = 0;
  std::map<std::size_t, ShiftPlace> worst_;  ///< by offset
  std::map<std::size_t, Box> boxes_;         ///< by offset
  std::vector<long> tools_;
  std::set<std::pair<std::size_t, long>> pairs_;
  std::set<long> contours_;
  bool at_platform_ = false;
};

/// Solves the program with a shift in effect, and gives the waypoints to `found`.
using ShiftPass = std::function<std::optional<Failure>(const ConstantShift& shift, ShiftPlaces& found)>;

struct BestShift {
  std::optional<Failure> failure{};  ///< then the rest does not count
  std::vector<Pose> offsets{};       ///< by number: what is added to it, as in `ConstantShift::frames`
  std::map<long, double> lengths{}, radii{};  ///< as in `ConstantShift`
  double largest = 0;                         ///< deviation of the program with it
  double gap = 0;                             ///< the least one is at most so much smaller
  std::size_t passes = 0;
};

/// The shift of frames whose offsets are shifted by `offsets`.
ConstantShift shift_of(const ShiftFreedom& freedom, const BestShift& best);

/// The shift that minimises the largest norm of the position deviation over all places that are taken. Where
/// several offsets share tools, first that of them together; then, with the lengths and radii found, that of
/// each offset. The smallest change of several equally good ones.
///
/// Minimises over a bounded set of places, each solved with the shift in effect, and adds those that a pass
/// over the whole program finds to be larger, until no one exceeds it by more than 0.01 µm: at most twelve
/// passes. `first`: of the program without a shift. `threads` changes nothing.
BestShift best_shift(const ShiftFreedom& freedom, const ShiftPlaces& first, const ShiftPass& pass,
                     int threads, const StartTables* starts = nullptr);

}  // namespace counterflex
