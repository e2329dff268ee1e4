// The places that decide over a constant shift, and how it moves commands.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "compensation/shift/commands.hpp"
#include "compensation/solve/commands.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

// Along the path; even. Over 17 programs 39 passes; with 256 and 64 samples 61 and 84.
constexpr std::size_t most_samples = 512;
constexpr std::size_t most_strata = 8192;   // beyond it only the largest deviation of an offset is kept
constexpr std::size_t most_largest = 1024;  // of the strata

// Solvers for different processors agree to less: of deviations that differ by less the first is the largest.
constexpr double indistinct = 1e-11;

// The face of a cube that a direction goes through.
long face_of(const Vector3& d) {
  Eigen::Index axis = 0;
  d.cwiseAbs().maxCoeff(&axis);
  return 2 * axis + (d[axis] > 0 ? 1 : 0);
}

// A cell of 32 mm: where an offset is turned, the shift differs from place to place.
long cell_of(const Vector3& p) {
  constexpr double edge = 0.032;
  constexpr long across = 64;
  const auto index = [](double x) { return static_cast<long>(std::floor(x / edge)) & (across - 1); };
  return (index(p.x()) * across + index(p.y())) * across + index(p.z());
}

// The side of the cutter, where the segment is beside a contour.
Vector3 away_beside(const Job& job, std::size_t s, double u) {
  const Segment& segment = job.path.segments[s];
  const CutterSide side = job.program.moves[segment.move].cutter_side;
  if (side == CutterSide::none) return Vector3::Zero();
  const Vector3 z = job.path.frames[segment.frame].X_MW.R.col(2);
  const Vector3 left = z.cross(direction_at(segment.wanted, u));
  if (left.norm() < 1e-9) return Vector3::Zero();
  return (side == CutterSide::left ? 1 : -1) * left.normalized();
}

bool same_contour(const Job& job, std::size_t a, std::size_t b) {
  const Move& first = job.program.moves[job.path.segments[a].move];
  const Move& second = job.program.moves[job.path.segments[b].move];
  return first.group != 0 && first.group == second.group;
}

void move_curve(Curve& curve, const Vector3& start, const Vector3& end) {
  curve.start += start;
  curve.end += end;
}

}  // namespace

void ShiftPlaces::add(const Job& job, const std::vector<Waypoint>& waypoints) {
  for (const Waypoint& w : waypoints) {
    if (!tool_cuts_at(job.program, w) || !w.place) continue;
    if (w.status != Status::converged) continue;
    const Move& move = job.program.moves[w.move];
    ShiftPlace place{.number = count_,
                     .line = w.line,
                     .wanted = wanted_at(model_of(job, w.move), w),
                     .command = original_command(job, move.frame, w.p_MT),
                     .F = w.wrench,
                     .directions = w.directions,
                     .frame = move.frame,
                     .tool = move.tool,
                     .deviation = w.after.head<3>()};
    if (w.segment != no_segment) place.away = away_from_contour(job, w.segment, w.fraction);
    at_platform_ = job.forces.at_platform();
    const std::size_t offset = freedom_->offset_of_frame[move.frame];
    if (std::find(tools_.begin(), tools_.end(), place.tool) == tools_.end()) tools_.push_back(place.tool);
    pairs_.insert({offset, place.tool});
    if (!place.away.isZero(0)) contours_.insert(place.tool);
    Box& box = boxes_[offset];
    box.least = box.least.cwiseMin(w.p_MT);
    box.most = box.most.cwiseMax(w.p_MT);
    keep(place, offset);
    sample(place);
    ++count_;
  }
}

void ShiftPlaces::keep(const ShiftPlace& place, std::size_t offset) {
  const auto is_larger = [&](const ShiftPlace& than) {
    return place.deviation.norm() > than.deviation.norm() + indistinct;
  };
  const auto [worst, is_first] = worst_.try_emplace(offset, place);
  if (!is_first && is_larger(worst->second)) worst->second = place;
  // Of six directions of the deviation. Without directions 54 passes in place of 39, and a shift that leaves
  // 0.02 mm more.
  const long is_beside_contour = place.away.norm() < 1e-9 ? 0 : 1,
             kind = (2 * static_cast<long>(offset) + is_beside_contour) * 6 + face_of(place.deviation);
  const Stratum stratum{place.tool, kind, freedom_->turns ? cell_of(place.wanted.p_MT) : 0};
  const auto found = strata_.find(stratum);
  if (found != strata_.end()) {
    if (is_larger(found->second)) found->second = place;
  } else if (strata_.size() < most_strata) {
    strata_.emplace(stratum, place);
  }
}

// Every place, every second one, ...: those whose number is a multiple of the spacing.
void ShiftPlaces::sample(const ShiftPlace& place) {
  if (place.number % spacing_ != 0) return;
  if (samples_.size() == most_samples) {
    for (std::size_t i = 0; i < most_samples / 2; ++i) samples_[i] = samples_[2 * i];
    samples_.resize(most_samples / 2);
    spacing_ *= 2;
    if (place.number % spacing_ != 0) return;
  }
  samples_.push_back(place);
}

std::vector<ShiftPlace> ShiftPlaces::places() const {
  std::map<std::size_t, ShiftPlace> all;
  for (const ShiftPlace& place : samples_) all.emplace(place.number, place);
  std::vector<const ShiftPlace*> largest;
  for (const auto& [stratum, place] : strata_) largest.push_back(&place);
  std::ranges::stable_sort(largest, [](const ShiftPlace* a, const ShiftPlace* b) {
    return a->deviation.norm() > b->deviation.norm();
  });
  largest.resize(std::min(largest.size(), most_largest));
  for (const ShiftPlace* place : largest) all.emplace(place->number, *place);
  for (const auto& [offset, place] : worst_) all.emplace(place.number, place);
  std::vector<ShiftPlace> in_order;
  for (const auto& [number, place] : all) in_order.push_back(place);
  return in_order;
}

double ShiftPlaces::largest(std::size_t offset) const {
  const auto found = worst_.find(offset);
  return found == worst_.end() ? 0 : found->second.deviation.norm();
}

bool ShiftPlaces::has(std::size_t offset) const {
  return worst_.contains(offset);
}

ShiftPlaces::Box ShiftPlaces::box(std::size_t offset) const {
  const auto found = boxes_.find(offset);
  return found == boxes_.end() ? Box{} : found->second;
}

Vector3 away_from_contour(const Job& job, std::size_t segment, double u) {
  const Move& move = job.program.moves[job.path.segments[segment].move];
  if (move.cutter_side != CutterSide::none) return away_beside(job, segment, u);
  if (move.group == 0) return Vector3::Zero();
  const bool comes = segment > 0 && same_contour(job, segment - 1, segment);
  const bool goes = segment + 1 < job.path.segments.size() && same_contour(job, segment, segment + 1);
  const Vector3 start = comes ? away_beside(job, segment - 1, 1) : Vector3::Zero();
  const Vector3 end = goes ? away_beside(job, segment + 1, 0) : Vector3::Zero();
  return start + u * (end - start);
}

double length_of(const std::map<long, double>& lengths, long tool) {
  const auto found = lengths.find(tool);
  return found == lengths.end() ? 0 : found->second;
}

Vector3 tool_axis_at_home(const Model& model) {
  return tip(model.mechanism, model.home).R.col(2);
}

void shift_pieces(const Job& job, const ConstantShift& shift, std::vector<Piece>& pieces) {
  const Vector3 axis = tool_axis_at_home(job.model);
  for (Piece& piece : pieces) {
    const long tool = job.program.moves[piece.move].tool;
    const double radius = piece.segment == no_segment ? 0 : length_of(shift.radii, tool);
    if (!shift.frames.empty()) {
      const Pose& by = shift.frames[piece.frame];
      piece.commanded = by * piece.commanded;
      if (piece.turn) piece.turn = by.R * *piece.turn;
    }
    const Vector3 back = length_of(shift.lengths, tool) * axis;
    move_curve(piece.commanded, back, back);
    if (piece.commanded.arc) piece.commanded.arc->centre += back;
    if (radius == 0) continue;
    move_curve(piece.commanded, radius * away_from_contour(job, piece.segment, piece.u0),
               radius * away_from_contour(job, piece.segment, piece.u1));
  }
}

}  // namespace counterflex
