#pragma once
/// The blocks of a coupon's program. Lengths in mm, program coordinates.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "counterflex/identify/coupon.hpp"

namespace counterflex {

inline constexpr double clear_above_mm = 2, safe_above_mm = 10;  // above the stock
inline constexpr double plunge_share = 1.0 / 3;                  // of the feed

struct Place2 {
  double x = 0, y = 0;
};

/// Text of a program, line by line.
class CouponText {
 public:
  explicit CouponText(const CouponRequest& request) : request_(request) {}

  int add(const std::string& line) {
    text_ += line + "\n";
    return ++line_;
  }
  int lines() const { return line_; }
  std::string take() { return std::move(text_); }

  double top() const { return request_.most_mm.z(); }

  /// The name of an operation: forces can be given by it.
  void operation(const std::string& work, const std::string& feature, bool is_corrected) {
    std::string name = fmt::format("({} {} {})", work, feature, is_corrected ? "corrected" : "not corrected");
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
    add(name);
  }

  /// All words: what the move before has left in an axis does not matter.
  void rapid_above(const Place2& p) {
    add(fmt::format("G0 X{:.4f} Y{:.4f} Z{:.4f}", p.x, p.y, top() + safe_above_mm));
    add(fmt::format("G0 Z{:.4f}", top() + clear_above_mm));
  }
  void plunge(double z) { add(fmt::format("G1 Z{:.4f} F{:.1f}", z, request_.feed_mm_min * plunge_share)); }
  int line_to(const Place2& p) {
    return add(fmt::format("G1 X{:.4f} Y{:.4f} F{:.1f}", p.x, p.y, request_.feed_mm_min));
  }
  int line_to(const Place2& p, double z) {
    return add(fmt::format("G1 X{:.4f} Y{:.4f} Z{:.4f} F{:.1f}", p.x, p.y, z, request_.feed_mm_min));
  }
  /// A full circle, counter-clockwise, from the point at the right of its centre.
  int circle(const Place2& centre, double radius, double z) {
    return add(fmt::format("G3 X{:.4f} Y{:.4f} Z{:.4f} I{:.4f} J0.0000 F{:.1f}", centre.x + radius, centre.y,
                           z, -radius, request_.feed_mm_min));
  }
  void retract() { add(fmt::format("G0 Z{:.4f}", top() + safe_above_mm)); }

 private:
  const CouponRequest& request_;
  std::string text_;
  int line_ = 0;
};

}  // namespace counterflex
