#pragma once
/// The plan for each block with motion, before any machine is known: which are corrected by themselves,
/// which hold a shift, which stay as they are, and why.
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// How much is cut.
struct CutLength {
  double known_mm = 0;      ///< of feed moves whose start and end are known
  std::size_t unknown = 0;  ///< other feed moves, and calls and cycles that are not followed
};

/// Blocks that share a fate and its reason.
struct PlanRow {
  std::string why;
  std::size_t count = 0;
  CutLength cut;
  std::vector<int> lines;     ///< of the first of them, at most `lines_of_row`
  bool must_be_zero = false;  ///< a correction that is not zero there is refused
};

inline constexpr std::size_t lines_of_row = 5;

/// A contour under G41 or G42, which moves as a whole.
struct PlanGroup {
  int number = 0;
  int first_line = 0, last_line = 0;
  std::size_t moves = 0;
};

struct MotionPlan {
  std::size_t moves = 0;          ///< blocks with motion, machine positions among them
  std::size_t corrected = 0;      ///< by the correction of their own end
  std::size_t held = 0;           ///< keep the correction with which they are entered
  std::size_t grouped = 0;        ///< in contour groups
  std::size_t not_corrected = 0;  ///< machine positions, unknown places, blocks that are not followed
  CutLength corrected_cut, held_cut, grouped_cut, left_cut;
  std::vector<PlanRow> held_rows,
      left_rows;  ///< the most costly first: by length, by moves of unknown length, by blocks
  std::vector<PlanRow> other_rows;  ///< blocks without motion that are not followed
  std::vector<PlanGroup> groups;
  std::array<std::size_t, 3> arcs{};  ///< in the planes XY, XZ, YZ
  std::size_t cycles = 0, relative = 0, inverse_time = 0;
  std::map<long, std::size_t> tools;  ///< moves by tool in the spindle; 0: none known
};

/// Makes the plan of a program from its windows, in order. A word programmed before all axes are known counts
/// as corrected where a position that is known follows within 64 blocks.
class MotionPlanner {
 public:
  void add(const Program& window);
  MotionPlan plan() const;

 private:
  class Window;

  /// What a window leaves for the next one.
  struct Carried {
    std::optional<LeftAlone> reason{};  ///< the last one that moves were left alone for
    bool doubtful = false;              ///< `leaves_doubt` of the last move
    std::array<bool, 3> holds{};        ///< by axis, whether the text holds a correction
  };

  MotionPlan plan_;
  Carried carried_;
};

/// The plan of a program that is one window.
MotionPlan motion_plan(const Program& program);

}  // namespace counterflex
