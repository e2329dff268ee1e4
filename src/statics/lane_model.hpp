#pragma once
/// A mechanism made ready for the lane kernels, and what is to be found of it in the other form.
#include <deque>
#include <map>
#include <memory>
#include <vector>

#include "counterflex/statics/equilibrium.hpp"
#include "lane_program.hpp"
#include "series.hpp"

namespace counterflex {

/// A series in every form that it has. In the order of the lane program: branches before the series that holds them.
struct SeriesView {
  const Series* series;
  const SeriesState* state;
  SeriesWork* work;
  const Pose* end;
  bool is_chain;
};
std::vector<SeriesView> views(const Mechanism& mechanism, const Configuration& configuration, std::vector<SeriesWork>& works);

/// The flat program of a mechanism; it owns what the program points to.
class LaneModel {
 public:
  /// `at_platform`: where loads act, as `Load` has it.
  LaneModel(const Model& model, bool at_platform);
  LaneModel(const LaneModel&) = delete;

  /// Whether the kernels can do with this machine: it controls x, y and z of the tip, and has no more actuators
  /// and series than kernels have room for.
  static bool can_do(const Mechanism& mechanism);

  const lanes::Program& program() const { return program_; }
  bool at_platform() const { return at_platform_; }

  /// The state of a configuration as the kernels hold it.
  std::vector<double> state_of(const Configuration& configuration) const;

  /// The step of everything that takes a state to another one: rows of the series, then the platform's twist.
  std::vector<double> step_between(const std::vector<double>& from, const std::vector<double>& to) const;

  /// The configuration of a state; `like` says what states do not hold.
  Configuration configuration_of(const double* state, const Configuration& like) const;

 private:
  template <typename Visit>
  static void for_each_coordinate(const Series& series, const std::vector<lanes::Part>& parts, const Visit& visit);

  struct Standing;
  void flatten(const Series& series, lanes::Series& flat);
  void number_rows(const Series& series, lanes::Series& flat);
  void add_joint(const Part& part, int row, Standing& standing, std::vector<lanes::Part>& parts);
  void add_spring(const Part& part, int row, std::vector<lanes::Part>& parts);
  void add_mass(const Part& part, Standing& standing, std::vector<lanes::Part>& parts);
  void add_group(const Part& part, int row, std::vector<lanes::Part>& parts);
  void put_down(Standing& standing, std::vector<lanes::Part>& parts);
  void join_ends(const std::vector<SeriesView>& list);
  void describe_machine();
  void place_tangents();

  const Model& model_;
  const bool at_platform_;
  lanes::Program program_{};
  std::vector<const Series*> order_;
  std::vector<lanes::Series> series_;
  std::deque<std::vector<lanes::Part>> parts_;
  std::deque<std::vector<double>> springs_;
  std::deque<std::unique_ptr<bool[]>> angular_;
  std::vector<lanes::FixedPose> fixed_[2];
  std::vector<int> actuator_numbers_, controlled_;
};

}  // namespace counterflex
