#include "statics/kernel/machine/flatten.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "counterflex/geometry/pose.hpp"
#include "statics/kernel/equations/work.hpp"

namespace counterflex::kernel {
namespace {

using ModelSeries = counterflex::Series;

bool is_joint(const Part& part) {
  return part.kind == PartKind::actuator || part.kind == PartKind::passive ||
         part.kind == PartKind::compliance;
}
bool is_rigid(const Part& part) {
  return part.kind == PartKind::fixed || part.kind == PartKind::error;
}

TransformFactor factor_of(const Part& part) {
  return {part.X, part.log_R, part.kind == PartKind::error};
}

/// A rotation whose z axis is `axis`.
Matrix3 z_along(const Vector3& axis) {
  Matrix3 R;
  R.col(2) = axis;
  R.col(0) = Vector3::UnitZ().cross(axis).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return R;
}

SpringShape shape_of(const Matrix6& K) {
  bool diagonal = true, beam = true;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      if (i == j || K(i, j) == 0) continue;
      diagonal = false;
      beam = beam && (i < 3) != (j < 3) && i % 3 != j % 3;
    }
  return diagonal ? SpringShape::diagonal : beam ? SpringShape::beam : SpringShape::full;
}

Spring spring_of(const Part& part) {
  Spring spring;
  for (int i = 0; i < 36; ++i) at(spring.K, i) = part.K(i / 6, i % 6);
  for (int i = 0; i < 6; ++i) at(spring.theta_0, i) = part.theta_0[i];
  spring.shape = shape_of(part.K);
  return spring;
}

/// Joints, and products of rigid transforms between them.
struct Stretch {
  struct Item {
    FrameStep step;
    TransformProduct transform;
    Flat::Place place;
  };
  std::vector<Item> items;
  TransformProduct open;

  void close() {
    if (!open.empty()) items.push_back({{}, std::move(open), {}});
    open = {};
  }
};

enum class Frames { nodes, starts, ends };

struct PlacedWeight {
  Frames with;
  int number;  ///< of the node, or of the series whose start or end it is
  double mass;
  TransformProduct place;
};

/// The flat machine while it is put together.
struct Parts {
  Flat flat;
  std::vector<PlacedWeight> weights;

  int add_transform(TransformProduct product) {
    flat.transforms.push_back(std::move(product));
    return static_cast<int>(flat.transforms.size()) - 1;
  }
  int add_spring(const Spring& spring) {
    flat.machine.springs.push_back(spring);
    return static_cast<int>(flat.machine.springs.size()) - 1;
  }
  int add_weight(double mass, TransformProduct place) {
    flat.machine.weights.push_back({mass, add_transform(std::move(place))});
    return static_cast<int>(flat.machine.weights.size()) - 1;
  }
  Weights place_weights(Frames with, int number) {
    Weights placed{static_cast<int>(flat.machine.weights.size()), 0};
    for (const PlacedWeight& weight : weights) {
      if (weight.with != with || weight.number != number) continue;
      add_weight(weight.mass, weight.place);
      ++placed.count;
    }
    return placed;
  }
};

/// One chain or branch: its elements, in order, as number `number` of the flat machine.
class SeriesFlattener {
 public:
  SeriesFlattener(const ModelSeries& series, int number, bool is_chain, Parts& parts)
      : series_(series), number_(number), is_chain_(is_chain), parts_(parts), machine_(parts.flat.machine) {}

  void run() {
    for (std::size_t k = 0; k < series_.parts.size(); ++k)
      if (!is_left_out(series_.parts[k])) add(series_.parts[k], k);
    if (has_six_)
      close_element(-1);
    else
      close_rigidly();
    write();
  }

 private:
  bool is_left_out(const Part& part) const {
    return parts_.flat.rigid && (part.kind == PartKind::spring || part.kind == PartKind::compliance ||
                                 part.kind == PartKind::mass);
  }

  void add(const Part& part, std::size_t k) {
    if (is_rigid(part)) {
      stretch().open.push_back(factor_of(part));
      from_node_.push_back(factor_of(part));
    } else if (is_joint(part)) {
      add_joint(part);
      leave_frame(part);
    } else if (is_six(parts_.flat, part)) {
      if (has_six_) close_element(add_node(k));
      begin_six(part);
      leave_frame(part);
    } else {
      add_mass(part, k);
    }
  }

  Stretch& stretch() { return has_six_ ? after_ : front_; }

  void leave_frame(const Part& part) {
    at_start_ = at_start_ && is_chain_ && part.kind == PartKind::actuator;
    node_ = -1;
  }

  void add_joint(const Part& part) {
    const bool rigid = parts_.flat.rigid;
    FrameStep step;
    step.kind = part.joint.kind == JointKind::prismatic ? StepKind::slide : StepKind::turn;
    step.actuator = part.actuator;
    if (part.kind == PartKind::actuator) at(machine_.actuator_offset, part.actuator) = part.offset;
    if (!part.errors.empty() && !rigid) {
      step.motion = static_cast<int>(machine_.motions.size());
      const Vector3& axis = part.joint.axis;
      machine_.motions.push_back({step.kind == StepKind::turn, {axis[0], axis[1], axis[2]}, part.errors});
      return put_joint(step, part);
    }
    step.axis = -1;
    for (int i = 0; i < 3; ++i)
      for (const double sign : {1.0, -1.0})
        if (part.joint.axis == sign * Vector3::Unit(i)) step.axis = i, step.sign = sign;
    const bool oblique = step.axis < 0;
    const Pose turned = rotation(oblique ? z_along(part.joint.axis) : Matrix3::Identity());
    if (oblique) step.axis = 2, stretch().open.push_back({turned});
    step.passive = part.kind == PartKind::passive;
    if (!rigid) step.k = part.k, step.k_change = part.k_change, step.knee = part.knee;
    machine_.has_knees = machine_.has_knees || step.k_change != 0;
    step.rest = step.passive ? part.rest : 0;
    put_joint(step, part);
    if (oblique) stretch().open.push_back({inverse(turned)});
  }

  void put_joint(const FrameStep& step, const Part& part) {
    stretch().close();
    stretch().items.push_back({step, {}, {number_, part.column}});
  }

  void begin_six(const Part& part) {
    has_six_ = true;
    if (part.kind == PartKind::spring) {
      element_.spring = parts_.add_spring(spring_of(part));
      return;
    }
    const auto& branches = at(series_.groups, part.group).branches;
    element_.kind = ElementKind::group;
    element_.branches = static_cast<int>(branches.size());
    const int first = static_cast<int>(machine_.series.size());
    element_.series = first;
    machine_.series.resize(machine_.series.size() + branches.size());
    for (int b = 0; b < element_.branches; ++b)
      SeriesFlattener(at(branches, b), first + b, false, parts_).run();
  }

  /// A mass rides with the start, the end or a node behind a six-element, or hangs between joints.
  void add_mass(const Part& part, std::size_t k) {
    if (is_chain_ && at_start_) return;  // only actuators move it: no equilibrium depends on it
    const auto behind = series_.parts.begin() + static_cast<std::ptrdiff_t>(k) + 1;
    const bool at_end = std::none_of(behind, series_.parts.end(),
                                     [&](const Part& p) { return is_joint(p) || is_six(parts_.flat, p); });
    machine_.has_hanging_weights =
        machine_.has_hanging_weights || !is_chain_ || !(has_six_ || at_end || node_ >= 0);
    if (at_start_) return place_weight(Frames::starts, number_, part, from_node_);
    if (at_end) {
      TransformProduct rest;
      for (auto p = behind; p != series_.parts.end(); ++p)
        if (is_rigid(*p)) rest.push_back(factor_of(*p));
      return place_weight(Frames::ends, number_, part, inverse_of(std::move(rest)));
    }
    if (has_six_) {
      node_ = add_node(k);
      close_element(node_);
      from_node_.clear();
    }
    if (node_ >= 0) return place_weight(Frames::nodes, node_, part, from_node_);
    front_.close();
    FrameStep step;
    step.kind = StepKind::weight;
    step.weight = parts_.add_weight(part.mass, {{part.X}});
    front_.items.push_back({step, {}, {}});
  }

  void place_weight(Frames with, int number, const Part& part, TransformProduct place) {
    place.push_back({part.X});
    parts_.weights.push_back({with, number, part.mass, std::move(place)});
  }

  int add_node(std::size_t part) {
    parts_.flat.nodes.push_back({number_, static_cast<int>(part)});
    return machine_.nodes++;
  }

  /// Joints without a six-element behind them: a spring K and a spring -K in series hold them rigidly to the
  /// end. In tangents the second one is stiffer by a little: where the joints before it do not move in all
  /// directions the node's pivots were zero else (EQUATIONS.md, section 11).
  void close_rigidly() {
    if (parts_.flat.rigid) return close_by_spring(1, 1, -1);
    close_by_spring(1, 1, add_node(series_.parts.size()));
    close_by_spring(-1, 1 + closure_surplus, -1);
    ++machine_.rigid_closures;
  }

  void close_by_spring(double sign, double tangent_factor, int node) {
    const double k = sign * machine_.stiffest, l = machine_.length;
    Spring spring;
    spring.shape = SpringShape::isotropic;
    spring.tangent_factor = tangent_factor;
    for (int i = 0; i < 6; ++i) at(spring.K, 7 * i) = k * (i < 3 ? 1 : l * l);
    element_.spring = parts_.add_spring(spring);
    close_element(node);
  }

  void close_element(int node) {
    emit(front_, false, element_.front, element_.fronts);
    emit(after_, true, element_.after, element_.afters);
    element_.node = node;
    elements_.push_back(element_);
    element_ = {};
    front_ = after_ = {};
    has_six_ = false;
  }

  /// Writes the steps of a stretch, backwards where they lead from the end frame to the element.
  void emit(Stretch& stretch, bool backwards, int& first, int& count) {
    stretch.close();
    if (backwards) std::reverse(stretch.items.begin(), stretch.items.end());
    first = static_cast<int>(machine_.steps.size());
    count = static_cast<int>(stretch.items.size());
    for (Stretch::Item& item : stretch.items) {
      FrameStep step = item.step;
      step.direction = backwards ? -1 : 1;
      if (step.kind == StepKind::transform) {
        step.transform = parts_.add_transform(backwards ? inverse_of(std::move(item.transform))
                                                        : std::move(item.transform));
      } else if (step.is_joint()) {
        step.joint = machine_.joints++;
        machine_.joint_turns.push_back(step.kind == StepKind::turn);
        parts_.flat.joints.push_back(item.place);
        if (step.actuator >= 0) at(machine_.actuator_joint, step.actuator) = step.joint;
      }
      machine_.steps.push_back(step);
    }
  }

  void write() {
    Series& flat = at(machine_.series, number_);
    flat.first = static_cast<int>(machine_.elements.size());
    flat.count = static_cast<int>(elements_.size());
    flat.actuators = static_cast<int>(machine_.actuators.size());
    flat.actuator_count = static_cast<int>(series_.actuators.size());
    if (flat.actuator_count > most_actuators_of_series) parts_.flat.is_solvable = false;
    machine_.most_actuators = std::max(machine_.most_actuators, flat.actuator_count);
    machine_.actuators.insert(machine_.actuators.end(), series_.actuators.begin(), series_.actuators.end());
    for (Element& element : elements_) number_actuators(element);
    machine_.elements.insert(machine_.elements.end(), elements_.begin(), elements_.end());
  }

  int slot_of(int actuator) const {
    const auto found = std::find(series_.actuators.begin(), series_.actuators.end(), actuator);
    return static_cast<int>(found - series_.actuators.begin());
  }

  /// In the order of elimination: those of its branches, then the joints, nearest first.
  void number_actuators(Element& element) {
    element.slots = static_cast<int>(machine_.slots.size());
    for (int b = 0; b < element.branches; ++b) {
      const Series& branch = at(machine_.series, element.series + b);
      for (int i = 0; i < branch.actuator_count; ++i)
        machine_.slots.push_back(slot_of(at(machine_.actuators, branch.actuators + i)));
    }
    number_joints(element, element.front, element.fronts);
    number_joints(element, element.after, element.afters);
  }

  void number_joints(const Element& element, int first, int count) {
    for (int i = first + count - 1; i >= first; --i) {
      FrameStep& step = at(machine_.steps, i);
      if (!step.is_joint()) continue;
      step.actuators_before = static_cast<int>(machine_.slots.size()) - element.slots;
      step.coupling = machine_.couplings;
      if (step.actuator >= 0)
        machine_.slots.push_back(slot_of(step.actuator));
      else
        machine_.couplings += step.actuators_before;
    }
  }

  const ModelSeries& series_;
  const int number_;
  const bool is_chain_;
  Parts& parts_;
  FlatMachine& machine_;
  std::vector<Element> elements_{};
  Element element_{};  // the one that is being read, with the joints on both sides
  Stretch front_{}, after_{};
  bool has_six_ = false;
  bool at_start_ = true;          // this place rides with the start; in a chain, up to actuators
  int node_ = -1;                 // the node with which it rides, if there is one
  TransformProduct from_node_{};  // from that node, or from the start
};

Flat flatten(const Mechanism& mechanism, bool load_at_platform, bool rigid) {
  Parts parts;
  parts.flat.rigid = rigid;
  FlatMachine& machine = parts.flat.machine;
  machine.chains = static_cast<int>(mechanism.chains.size());
  machine.series.resize(mechanism.chains.size());
  machine.length = mechanism.length;
  const double stiffest = mechanism.stiffest > 0 ? mechanism.stiffest : stiff_enough;
  machine.stiffest = rigid ? kinematic_stiffness : stiffest;
  machine.actuator_joint.resize(mechanism.travel.size(), -1);
  machine.actuator_offset.resize(mechanism.travel.size(), 0);
  for (const Component c : mechanism.controlled) machine.controlled[static_cast<std::size_t>(c)] = true;
  machine.X_PT = transform_of(mechanism.X_PT);
  const Vector3 arm = load_at_platform ? mechanism.p_EP : mechanism.X_PT.p;
  for (int i = 0; i < 3; ++i) at(machine.p_arm, i) = arm[i], at(machine.gravity, i) = mechanism.gravity[i];
  for (int s = 0; s < machine.chains; ++s) SeriesFlattener(at(mechanism.chains, s), s, true, parts).run();
  for (int node = 0; node < machine.nodes; ++node)
    machine.weights_of_node.push_back(parts.place_weights(Frames::nodes, node));
  for (int s = 0; s < static_cast<int>(machine.series.size()); ++s) {
    at(machine.series, s).at_start = parts.place_weights(Frames::starts, s);
    at(machine.series, s).at_end = parts.place_weights(Frames::ends, s);
  }
  return std::move(parts.flat);
}

}  // namespace

Flat flatten(const Mechanism& mechanism, bool load_at_platform) {
  return flatten(mechanism, load_at_platform, false);
}
Flat flatten_rigid(const Mechanism& mechanism) {
  return flatten(mechanism, false, true);
}

}  // namespace counterflex::kernel
