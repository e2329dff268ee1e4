#include "identify/coupon/coupon_half.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

// Sizes in tool diameters. Columns and rows of a half have these widths at least; a larger box stretches
// them.
constexpr double columns[] = {3.6, 4.4, 3.6}, rows[] = {2.6, 4.4, 4.4, 2.6};
constexpr double wall_thickness = 0.6, allowance = 0.05, most_depth_of_cut = 0.5;
constexpr double hole_path = 0.35;      // radius of the path
constexpr double gap = 0.05;            // between features, at least
constexpr double steepest = 0.1;        // ramp: depth over length
constexpr double measured_share = 0.7;  // of a wall: its ends are not measured
constexpr double turn = pi / 4;         // of the square

double sum_of(const auto& list) {
  double sum = 0;
  for (const double value : list) sum += value;
  return sum;
}

Vector3 normal_at(double angle) {
  return {std::cos(angle), std::sin(angle), 0};
}

/// Writes the features of one half.
class HalfWriter {
 public:
  HalfWriter(const CouponRequest& request, double least_x, double width, bool is_corrected, CouponText& text,
             std::vector<CouponQuantity>& quantities)
      : request_(request),
        D_(request.diameter_mm),
        R_(D_ / 2),
        stock_(allowance * D_),
        depth_(request.most_mm.z() - request.least_mm.z()),
        least_x_(least_x),
        width_(width),
        is_corrected_(is_corrected),
        text_(text),
        quantities_(quantities) {}

  void write() {
    hole("hole 1", 0, 0);
    hole("hole 2", 2, 0);
    hole("hole 3", 0, 3);
    hole("hole 4", 2, 3);
    step("step 1", 1, 0, 1.0 / 3);
    step("step 2", 2, 1, 2.0 / 3);
    step("step 3", 0, 2, 1);
    wall("wall 1", 0, 1, 0);
    wall("wall 2", 2, 2, pi / 2);
    circle("circle", 1, 1);
    square("square", 1, 2);
  }

 private:
  struct Cell {
    Place2 centre;
    double width, height;
  };

  Cell cell(int column, int row) const {
    const double x_scale = width_ / sum_of(columns),
                 y_scale = (request_.most_mm.y() - request_.least_mm.y()) / sum_of(rows);
    double x = least_x_, y = request_.least_mm.y();
    for (int i = 0; i < column; ++i) x += columns[i] * x_scale;
    for (int i = 0; i < row; ++i) y += rows[i] * y_scale;
    const double w = columns[column] * x_scale, h = rows[row] * y_scale;
    return {{x + w / 2, y + h / 2}, w, h};
  }

  double bottom() const { return request_.least_mm.z(); }

  void add(const std::string& feature, const std::string& name, double nominal_mm,
           std::vector<CouponCut> cuts, double radius_share) {
    quantities_.push_back({feature, is_corrected_, name, nominal_mm, CouponFit::mean, std::move(cuts),
                           radius_share, Vector3::Zero()});
  }

  /// Depths of ramps of this length, the last one `z`.
  std::vector<double> levels(double z, double length) const {
    const double depth = text_.top() - z, most = std::min(most_depth_of_cut * D_, steepest * length);
    const int count = static_cast<int>(std::ceil(depth / most - 1e-9));
    std::vector<double> list;
    for (int i = 1; i <= count; ++i) list.push_back(text_.top() - depth * i / count);
    return list;
  }

  /// Ramps along a path down to `z`, then along it once at this depth. An open path is followed forth and
  /// back.
  void rough(const std::vector<Place2>& path, double z) {
    const bool is_closed = std::hypot(path.front().x - path.back().x, path.front().y - path.back().y) < 1e-9;
    std::vector<Place2> way = path;
    text_.rapid_above(way.front());
    text_.plunge(text_.top());
    double at = text_.top(), length = 0;
    for (std::size_t i = 1; i < way.size(); ++i)
      length += std::hypot(way[i].x - way[i - 1].x, way[i].y - way[i - 1].y);
    const auto follow = [&](double to) {
      double gone = 0;
      for (std::size_t i = 1; i < way.size(); ++i) {
        gone += std::hypot(way[i].x - way[i - 1].x, way[i].y - way[i - 1].y);
        text_.line_to(way[i], at + (to - at) * gone / length);
      }
      at = to;
      if (!is_closed) std::reverse(way.begin(), way.end());
    };
    for (const double level : levels(z, length)) follow(level);
    follow(z);
    text_.retract();
  }

  /// Finishes straight faces of a path around a part that is on its right: each from one corner to the next,
  /// its middle measured. Enters and leaves where the rough path was. Returns the lines of the middles.
  std::vector<int> finish(const Place2& from, const std::vector<Place2>& corners, double measured_mm,
                          const Place2& to) {
    text_.rapid_above(from);
    text_.plunge(bottom());
    text_.line_to(corners.front());
    std::vector<int> lines;
    for (std::size_t i = 1; i < corners.size(); ++i) {
      const Place2 &a = corners[i - 1], &b = corners[i];
      const double length = std::hypot(b.x - a.x, b.y - a.y), lead = (1 - measured_mm / length) / 2;
      const auto along = [&](double u) { return Place2{a.x + u * (b.x - a.x), a.y + u * (b.y - a.y)}; };
      text_.line_to(along(lead));
      lines.push_back(text_.line_to(along(1 - lead)));
      text_.line_to(b);
    }
    text_.line_to(to);
    text_.retract();
    return lines;
  }

  void add_circle(const std::string& feature, const Place2& centre, double path_radius, int line,
                  bool has_diameter) {
    CouponQuantity quantity{feature,
                            is_corrected_,
                            "x_centre_mm",
                            centre.x,
                            CouponFit::circle_x,
                            {{line}},
                            0,
                            Vector3(centre.x, centre.y, bottom())};
    quantities_.push_back(quantity);
    quantity.name = "y_centre_mm";
    quantity.nominal_mm = centre.y;
    quantity.fit = CouponFit::circle_y;
    quantities_.push_back(quantity);
    if (!has_diameter) return;
    quantity.name = "diameter_mm";
    quantity.nominal_mm = 2 * (path_radius + R_);
    quantity.fit = CouponFit::circle_diameter;
    quantity.radius_share = 2;
    quantities_.push_back(quantity);
  }

  /// Helix, then a full circle; the finish is a larger full circle.
  void bore(const std::string& feature, const Place2& c, double radius, bool has_diameter) {
    const double first = radius - stock_;
    text_.operation("rough", feature, is_corrected_);
    text_.rapid_above({c.x + first, c.y});
    text_.plunge(text_.top());
    for (const double level : levels(bottom(), 2 * pi * first)) text_.circle(c, first, level);
    text_.circle(c, first, bottom());
    text_.operation("finish", feature, is_corrected_);
    text_.line_to({c.x + radius, c.y});
    const int line = text_.circle(c, radius, bottom());
    text_.line_to({c.x + first, c.y});
    text_.retract();
    add_circle(feature, c, radius, line, has_diameter);
  }

  void hole(const std::string& feature, int column, int row) {
    bore(feature, cell(column, row).centre, hole_path * D_, false);
  }

  void circle(const std::string& feature, int column, int row) {
    const Cell in = cell(column, row);
    bore(feature, in.centre, std::min(in.width, in.height) / 2 - gap * D_ - R_, true);
  }

  /// A flat floor at a share of the depth. The finish ramps back to the beginning of the rough path.
  void step(const std::string& feature, int column, int row, double share) {
    const Cell in = cell(column, row);
    const double half = std::min(in.width / 2 - R_ - gap * D_, 2 * D_), z = text_.top() - share * depth_;
    const Place2 a{in.centre.x - half, in.centre.y}, b{in.centre.x + half, in.centre.y};
    text_.operation("rough", feature, is_corrected_);
    const double rough_z = z + std::min(stock_, share * depth_ / 2);
    rough({a, b}, rough_z);
    text_.operation("finish", feature, is_corrected_);
    static_assert(allowance / 0.5 <= steepest);
    text_.rapid_above({a.x + R_, a.y});
    text_.plunge(rough_z);
    text_.line_to(a, z);
    text_.line_to({a.x + R_, a.y});
    const int line = text_.line_to({b.x - R_, b.y});
    text_.line_to(b);
    text_.retract();
    add(feature, "z_mm", z, {{line, Vector3::UnitZ()}}, 0);
  }

  /// A wall between two slots; its faces are across `angle`.
  void wall(const std::string& feature, int column, int row, double angle) {
    const Cell in = cell(column, row);
    const Vector3 n = normal_at(angle), along = normal_at(angle + pi / 2);
    const double room = angle == 0 ? in.height : in.width, half = room / 2 - R_ - gap * D_;
    const double thickness = wall_thickness * D_, offset = thickness / 2 + R_;
    const auto at = [&](double across, double far) {
      const Vector3 p = Vector3(in.centre.x, in.centre.y, 0) + across * n + far * along;
      return Place2{p.x(), p.y()};
    };
    // The wall is on the right: forward on its lower side, back on the upper one.
    std::vector<int> lines;
    for (const double side : {-1.0, 1.0}) {
      const double first = side * (offset + stock_), last = side * offset, from = side * half;
      text_.operation("rough", feature, is_corrected_);
      rough({at(first, from), at(first, -from)}, bottom());
      text_.operation("finish", feature, is_corrected_);
      lines.push_back(finish(at(first, from), {at(last, from), at(last, -from)}, measured_share * 2 * half,
                             at(first, -from))[0]);
    }
    const Vector3 centre(in.centre.x, in.centre.y, 0);
    add(feature, angle == 0 ? "x_position_mm" : "y_position_mm", centre.dot(n),
        {{lines[0], n, 0.5}, {lines[1], n, 0.5}}, 0);
    add(feature, "width_mm", thickness, {{lines[0], -n, 1}, {lines[1], n, 1}}, -2);
  }

  void square(const std::string& feature, int column, int row) {
    const Cell in = cell(column, row);
    const double reach = std::min(in.width, in.height) / 2 - gap * D_ - R_;  // of the rough path
    const double path = reach * std::sqrt(2.0) - 2 * stock_, side = path - D_;
    const auto corner = [&](double length, int k) {  // clockwise: the square is on the right
      const double angle = turn + pi / 4 - k * pi / 2, far = length / std::sqrt(2.0);
      return Place2{in.centre.x + far * std::cos(angle), in.centre.y + far * std::sin(angle)};
    };
    std::vector<Place2> first, last;
    for (int k = 0; k <= 4; ++k) {
      first.push_back(corner(path + 2 * stock_, k));
      last.push_back(corner(path, k));
    }
    text_.operation("rough", feature, is_corrected_);
    rough(first, bottom());
    text_.operation("finish", feature, is_corrected_);
    const std::vector<int> lines = finish(first[0], last, measured_share * side, first[0]);
    // The face from corner k to k + 1 looks along turn - k * 90 degrees.
    const Vector3 centre(in.centre.x, in.centre.y, 0);
    for (int k = 0; k < 2; ++k) {
      const Vector3 n = normal_at(turn + k * pi / 2);
      const int angle_deg = static_cast<int>(std::lround((turn + k * pi / 2) / deg));
      const int upper = lines[k == 0 ? 0 : 3], lower = lines[k == 0 ? 2 : 1];
      add(feature, fmt::format("position_{}deg_mm", angle_deg), centre.dot(n),
          {{lower, n, 0.5}, {upper, n, 0.5}}, 0);
      add(feature, fmt::format("width_{}deg_mm", angle_deg), side, {{lower, -n, 1}, {upper, n, 1}}, -2);
    }
  }

  const CouponRequest& request_;
  double D_, R_, stock_, depth_, least_x_, width_;
  bool is_corrected_;
  CouponText& text_;
  std::vector<CouponQuantity>& quantities_;
};

}  // namespace

Place2 least_half(double diameter_mm) {
  return {sum_of(columns) * diameter_mm, sum_of(rows) * diameter_mm};
}

void add_half(const CouponRequest& request, double least_x, double width, bool is_corrected, CouponText& text,
              std::vector<CouponQuantity>& quantities) {
  HalfWriter(request, least_x, width, is_corrected, text, quantities).write();
}

}  // namespace counterflex
