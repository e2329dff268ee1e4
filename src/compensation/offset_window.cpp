#include "counterflex/compensation/offset_window.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>

#include "compensation/solve/solver.hpp"
#include "compensation/tuning.hpp"
#include "counterflex/compensation/windows.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/program/guard.hpp"

namespace counterflex {
namespace {

/// A corner: the shift of the origin of each frame (m), how the frame is turned about its own axes (rad),
/// and by how much the tool is longer (m).
struct Corner {
  Vector3 shift = Vector3::Zero();
  bool in_work_axes = false;  ///< else in those of M
  Vector3 turn = Vector3::Zero();
  double longer = 0;
};

Vector3 signs(unsigned bits) {
  return {bits & 1U ? 1.0 : -1.0, bits & 2U ? 1.0 : -1.0, bits & 4U ? 1.0 : -1.0};
}

/// Whether the axes of `R` are those of M, perhaps in another order: then their cube is the same.
bool is_aligned(const Matrix3& R) {
  constexpr double rounding = 1e-9;
  return (R.cwiseAbs().array() > rounding).count() == 3;
}

std::vector<Corner> corners_of(const OffsetQuestion& q, double half_width) {
  const bool aligned = std::all_of(q.frames.begin(), q.frames.end(),
                                   [](const WorkFrame& frame) { return is_aligned(frame.X_MW.R); });
  // The angles of a frame add up to turns about its axes: three times each of them is more than that. Each
  // corner of the turns is solved at two opposite corners of the shift: the turns are small.
  const double turn = q.turns ? 3 * guarded_angle_deg * deg : 0;
  std::vector<Corner> corners;
  for (const bool in_work_axes : {false, true})
    for (const double turned : q.turns ? std::vector{-turn, turn} : std::vector{0.0})
      for (const double longer : {-half_width, half_width})
        for (unsigned s = 0; s < 8; ++s)
          if ((!in_work_axes || !aligned) && (q.tool || longer > 0))
            corners.push_back({half_width * signs(s), in_work_axes, turned * signs(s), q.tool ? longer : 0});
  return corners;
}

/// How a corner moves the commands and the wanted path of one frame, in M (m).
struct FrameShift {
  Pose commanded, wanted;
};

Pose moved_about(const Pose& X_MW, const Vector3& shift, const Vector3& turn) {
  const Matrix3 R = X_MW.R * exp_so3(turn) * X_MW.R.transpose();
  return {R, Vector3(X_MW.p + shift - R * X_MW.p)};
}

/// Empty: the machine does not reach the place at which the part is touched off again.
std::optional<FrameShift> shift_of(const OffsetQuestion& q, const WorkFrame& frame, const Corner& corner) {
  const Vector3 shift = corner.in_work_axes ? Vector3(frame.X_MW.R * corner.shift) : corner.shift;
  FrameShift moved;
  moved.commanded = moved.wanted = moved_about(frame.X_MW, shift, corner.turn);
  const auto offset = q.machine.work.find(frame.name);
  if (offset == q.machine.work.end() || !offset->second.datum.touched_at) return moved;
  const Vector3 touched = offset->second.X_MW * *offset->second.datum.touched_at;
  const UnloadedDeviation before = unloaded_deviation({&q.model, touched}, q.starts);
  const UnloadedDeviation after = unloaded_deviation({&q.model, moved.commanded * touched}, q.starts);
  if (before.status != Status::converged || after.status != Status::converged) return std::nullopt;
  moved.wanted.p += after.d - before.d;
  return moved;
}

/// The largest share of the tolerance. Places that need not keep it may exceed it, or their own share, by a
/// small share.
double most_share(const OffsetQuestion& q, const Waypoint& at) {
  if (!at.exempt && !at.insignificant) return 1;
  return std::max(1.0, share_of_tolerance(q.options, q.model.mechanism, at.R_MT, at.after)) + small_share;
}

/// The machine with the tool of other lengths, and where its solutions start.
struct OtherLengths {
  std::map<double, Model> models;  ///< by what is added to the length (m)
  StartTables starts;              ///< after the models: they must outlive it
};

/// `frames`: how the corner moves them.
bool slice_holds(const OffsetQuestion& q, const Corner& corner, const OtherLengths& other,
                 const std::vector<FrameShift>& frames, std::span<const LoadPlace> places) {
  std::vector<TipPosition> positions;
  std::vector<ForwardRequest> requests;
  for (const LoadPlace& place : places) {
    const FrameShift& frame = frames[place.frame];
    const Model* model = q.tool == place.tool ? &other.models.at(corner.longer) : place.model;
    TipPosition wanted = wanted_at(*model, place.at);
    wanted.p_MT = frame.wanted * wanted.p_MT;
    if (wanted.R_MT) wanted.R_MT = Matrix3(frame.wanted.R * *wanted.R_MT);
    positions.push_back(wanted);
    ForwardRequest& request = requests.emplace_back(request_at(place));
    request.model = model;
    request.target = frame.commanded * place.target;
    request.within_travel = true;
    if (request.R) request.R = Matrix3(frame.commanded.R * *request.R);
  }
  std::vector<WantedPose> wanted(places.size());
  std::vector<ForwardAnswer> answers(places.size());
  PlaceSolver solver(q.tool ? &other.starts : q.starts, places.front().load.at_platform);
  solver.wanted(positions, wanted);
  solver.forwards(requests, answers);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (wanted[i].status != Status::converged || answers[i].status != Status::converged) return false;
    const Vector6 off = deviation(answers[i].X_MT, wanted[i].X_MT);
    if (share_of_tolerance(q.options, q.model.mechanism, positions[i].R_MT, off) >
        most_share(q, places[i].at))
      return false;
  }
  return true;
}

OtherLengths other_lengths(const OffsetQuestion& q, double half_width) {
  OtherLengths other;
  if (!q.tool) return other;
  for (const double longer : {-half_width, half_width}) {
    Machine machine = q.machine;
    *machine.tools.at(*q.tool).length += longer;
    ToolModels models = prepare_tools(machine, q.model, {*q.tool});
    other.models.emplace(longer, std::move(models.at(*q.tool)));
  }
  return other;
}

bool corner_holds(const OffsetQuestion& q, const Corner& corner, const OtherLengths& other) {
  std::vector<FrameShift> frames;
  for (const WorkFrame& frame : q.frames) {
    const auto shift = shift_of(q, frame, corner);
    if (!shift) return false;
    frames.push_back(*shift);
  }
  std::atomic<bool> holds = true;
  for_each_slice(q.places.size(), q.options.threads, [&](std::size_t begin, std::size_t count) {
    const auto places = std::span(q.places).subspan(begin, count);
    if (holds && !slice_holds(q, corner, other, frames, places)) holds = false;
  });
  return holds;
}

}  // namespace

bool window_holds(const OffsetQuestion& question, double half_width) {
  const OtherLengths other = other_lengths(question, half_width);
  const std::vector<Corner> corners = corners_of(question, half_width);
  return std::all_of(corners.begin(), corners.end(),
                     [&](const Corner& corner) { return corner_holds(question, corner, other); });
}

std::optional<double> offset_window(const OffsetQuestion& question) {
  const auto holds = [&](double step_mm) { return window_holds(question, step_mm * mm); };
  // All steps behind the first one that holds are smaller windows.
  const auto* found = std::partition_point(std::begin(window_steps_mm), std::end(window_steps_mm),
                                           [&](double step_mm) { return !holds(step_mm); });
  if (found == std::end(window_steps_mm)) return std::nullopt;
  return *found * mm;
}

}  // namespace counterflex
