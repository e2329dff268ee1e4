#include "forces/path/profile/position_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "counterflex/geometry/types.hpp"
#include "forces/path/profile/alignment.hpp"

namespace counterflex {
namespace {

// An arc is divided into chords that deviate by this fraction of the searched distance.
constexpr double flat_per_within = 1e-3;

// Largest number of passes near a point; limits the memory.
constexpr std::size_t most_visits = 1000;

// Rows closer together than this are at one place (m).
constexpr double same_place = 1e-9;

/// The segment in the coordinates of the log, m.
Curve logged_curve(const ForceProfile& log, const Program& window, const Segment& segment) {
  return log.machine_coordinates ? segment.wanted : curve_in({}, window.moves[segment.move]);
}

/// Equal parts of a curve, none longer than `longest`, that are straight to within `flat`.
int parts_of(const Curve& curve, double longest, double flat) {
  double parts = length(curve) / longest;
  if (curve.arc) {
    const double radius = radius_at(*curve.arc, curve.start);
    parts = std::max(parts, curve.arc->sweep / std::sqrt(8 * flat / std::max(radius, flat)));
  }
  return 1 + static_cast<int>(std::min(parts, 1e8));
}

/// The fraction of the line from a to b that is nearest to p.
double nearest_fraction(const Vector3& a, const Vector3& b, const Vector3& p) {
  const Vector3 way = b - a;
  const double squared = way.squaredNorm();
  return squared > 0 ? std::clamp(way.dot(p - a) / squared, 0.0, 1.0) : 0;
}

std::vector<Vector3> points_of(const ForceProfile& log) {
  std::vector<Vector3> points;
  for (std::size_t row = 0; row < log.rows.size(); ++row) points.push_back(log.rows.point(row));
  return points;
}

/// The rows at their path lengths (m). Rows at one place get the mean of their wrenches; if one of them ends
/// the cover, the result does.
std::vector<ForceRow> one_a_place(const ForceRows& rows, const std::vector<double>& keys) {
  std::vector<ForceRow> places;
  double count = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ForceRow row = rows[i];
    row.key = keys[i];
    const bool same = !places.empty() && row.key - places.back().key <= same_place;
    if (!same) {
      places.push_back(row);
      count = 1;
    } else if (row.ends || places.back().ends) {
      const double key = places.back().key;
      places.back() = row;
      places.back().key = key;
      count = 1;
    } else {
      places.back().F += (row.F - places.back().F) / ++count;
    }
  }
  return places;
}

}  // namespace

std::string shown_point(const Vector3& p) {
  return fmt::format("x {:.9g}, y {:.9g}, z {:.9g}", p.x() / mm, p.y() / mm, p.z() / mm);
}

void FarPoint::add(const Program& window, const Toolpath& path) {
  const Vector3 p = log_->rows.point(row_);
  for (const Segment& segment : path.segments) {
    if (!segment.cutting) continue;
    const Curve curve = logged_curve(*log_, window, segment);
    const int parts =
        parts_of(curve, std::numeric_limits<double>::infinity(), flat_per_within * *log_->within);
    for (int k = 0; k < parts; ++k) {
      const Vector3 a = point_at(curve, static_cast<double>(k) / parts),
                    b = point_at(curve, static_cast<double>(k + 1) / parts);
      const double squared = (a + nearest_fraction(a, b, p) * (b - a) - p).squaredNorm();
      if (squared_ >= 0 && squared >= squared_) continue;
      squared_ = squared;
      line_ = segment.line;
    }
  }
}

void FarPoint::refuse() const {
  const std::string point = shown_point(log_->rows.point(row_));
  if (squared_ < 0) fail_row(*log_, row_, point + " is on no feed move: the program has none");
  fail_row(*log_, row_,
           fmt::format("no feed move comes within {:.6g} mm of {}: the nearest is {:.4g} mm away, in line {}",
                       *log_->within / mm, point, std::sqrt(squared_) / mm, line_));
}

PositionLog::PositionLog(ForceProfile& log)
    : log_(&log),
      grid_(points_of(log), *log.within),
      visits_(log.rows.size()),
      approaches_(log.rows.size()) {}

void PositionLog::add(const Program& window, const Toolpath& path) {
  for (const Segment& segment : path.segments) {
    if (!segment.cutting) continue;
    const Curve curve = logged_curve(*log_, window, segment);
    if (!end_ || (*end_ - curve.start).norm() > same_place) ++piece_;  // a gap separates the passes
    end_ = curve.end;
    const int parts = parts_of(curve, grid_.cell(), flat_per_within * *log_->within);
    const auto s_at = [&](double u) { return segment.s_start + u * (segment.s_end - segment.s_start); };
    Vector3 a = curve.start;
    for (int k = 0; k < parts; ++k) {
      const double u0 = static_cast<double>(k) / parts, u1 = static_cast<double>(k + 1) / parts;
      const Vector3 b = point_at(curve, u1);
      add_piece(a, b, s_at(u0), s_at(u1));
      a = b;
    }
  }
}

void PositionLog::add_piece(const Vector3& a, const Vector3& b, double s0, double s1) {
  ++piece_;
  for (const std::uint32_t row : grid_.near(a, b)) {
    const Vector3 p = log_->rows.point(row);
    const double u = nearest_fraction(a, b, p);
    Approach& approach = approaches_[row];
    const bool is_next = approach.piece + 1 == piece_;
    const bool fell = is_next && approach.falls, listed = fell && approach.listed;
    approach = {piece_, u >= 1, false};
    if (u <= 0 && is_next) continue;  // the distance grows: the nearest place was on the previous piece
    const Visit here{s0 + u * (s1 - s0), (a + u * (b - a) - p).squaredNorm()};
    if (here.squared > *log_->within * *log_->within) continue;
    visit(row, here, listed);
    approach.listed = true;
  }
}

void PositionLog::visit(std::size_t row, const Visit& visit, bool replace) {
  std::vector<Visit>& visits = visits_[row];
  if (replace) visits.pop_back();
  visits.push_back(visit);
  if (visits.size() > most_visits)
    fail_row(*log_, row,
             fmt::format("the path comes within {:.6g} mm of {} more than {} times: a smaller within_mm is "
                         "required",
                         *log_->within / mm, shown_point(log_->rows.point(row)), most_visits));
}

std::optional<FarPoint> PositionLog::far_point() const {
  for (std::size_t row = 0; row < visits_.size(); ++row)
    if (visits_[row].empty()) return FarPoint(*log_, row);
  return std::nullopt;
}

void PositionLog::settle() {
  const OrderedPlaces places = in_order(visits_, *log_->within);
  if (places.stuck)
    fail_row(
        *log_, *places.stuck,
        fmt::format("the path passes {} only before the rows above it: rows must be in the order of logging",
                    shown_point(log_->rows.point(*places.stuck))));
  log_->rows = ForceRows(one_a_place(log_->rows, places.s));
  log_->key = ForceKey::path_length;
}

}  // namespace counterflex
