#pragma once
/// Programs compensated in parts.
#include <bit>

#include "compensation/window_run.hpp"
#include "counterflex/compensation/recorded_windows.hpp"
#include "counterflex/program/last_words.hpp"
#include "files/folder.hpp"

namespace counterflex::test {

inline const std::string one_run = "version 1, these options and files";

/// A program, how it is cut into windows, and what is asked of them.
struct Split {
  Order order;
  std::size_t least_moves = 12;
  bool attribution = false;
};

/// The files of all parts.
inline std::vector<std::string> record(const Split& split, std::size_t parts, const Folder& folder,
                                       int threads = 1) {
  std::vector<std::string> files;
  for (std::size_t p = 0; p < parts; ++p) {
    Order order = split.order;
    order.threads = threads;
    const std::size_t size = order.text.size(), begin = p * size / parts, end = (p + 1) * size / parts;
    WindowShop shop(order, split.least_moves);
    FileReader bytes = FileReader::of_bytes(order.text);
    const RecordedPart part{{begin, end}, last_words_before(begin, bytes, "part.ngc", order.read)};
    files.push_back(folder.file(fmt::format("{}-of-{}-{}", p, parts, threads)));
    WindowRun heard;
    record_windows(*shop.windows, shop.options, TextReader(shop.reader), split.attribution, part, one_run,
                   files.back(), events_for(heard))
        .publish();
  }
  return files;
}

struct Taken {
  WindowRun run;
  std::size_t taken = 0, compensated = 0;
};

inline Taken take_over(const Split& split, const std::vector<std::string>& files, int threads = 1) {
  Order order = split.order;
  order.threads = threads;
  WindowShop shop(order, split.least_moves);
  RecordedWindows recorded(files, one_run);
  Taken result;
  result.run.failure = compensate_windows(*shop.windows, shop.options, TextReader(shop.reader),
                                          split.attribution, events_for(result.run), recorded);
  result.taken = recorded.taken();
  result.compensated = recorded.compensated();
  return result;
}

template <typename Derived>
bool same_bits(const Eigen::MatrixBase<Derived>& a, const Eigen::MatrixBase<Derived>& b) {
  for (Eigen::Index i = 0; i < a.size(); ++i)
    if (std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i])) return false;
  return true;
}

inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

inline bool same_causes(const Causes& a, const Causes& b) {
  return same_bits(a.geometry, b.geometry) && same_bits(a.load, b.load) && same_bits(a.gravity, b.gravity) &&
         same_bits(a.superposition, b.superposition) && same_bits(a.air, b.air) &&
         same_bits(a.higher.deviation, b.higher.deviation) && a.higher.status == b.higher.status &&
         same_bits(a.lower.deviation, b.lower.deviation) && a.lower.status == b.lower.status;
}

inline bool same_waypoint(const Waypoint& a, const Waypoint& b) {
  return a.segment == b.segment && same_bits(a.fraction, b.fraction) && a.line == b.line &&
         a.cutting == b.cutting && a.between == b.between && a.place == b.place && a.exempt == b.exempt &&
         same_bits(a.weight, b.weight) && same_bits(a.s, b.s) && same_bits(a.p_MT, b.p_MT) &&
         same_bits(a.direction, b.direction) && same_bits(a.tool_axis, b.tool_axis) &&
         same_bits(a.wrench, b.wrench) && same_bits(a.before, b.before) && same_bits(a.after, b.after) &&
         same_bits(a.correction, b.correction) && a.status == b.status && a.iterations == b.iterations &&
         a.causes.has_value() == b.causes.has_value() && (!a.causes || same_causes(*a.causes, *b.causes));
}

inline void check_same_run(const WindowRun& a, const WindowRun& b) {
  CHECK(a.text == b.text);
  CHECK(a.windows == b.windows);
  CHECK(a.begun == b.begun);
  CHECK(a.inserted == b.inserted);
  CHECK(a.corrected == b.corrected);
  CHECK(same_bits(a.largest, b.largest));
  REQUIRE(a.left_alone.size() == b.left_alone.size());
  for (std::size_t i = 0; i < a.left_alone.size(); ++i) {
    CHECK(a.left_alone[i].line == b.left_alone[i].line);
    CHECK(a.left_alone[i].why == b.left_alone[i].why);
  }
  REQUIRE(a.waypoints.size() == b.waypoints.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.waypoints.size(); ++i)
    different += !same_waypoint(a.waypoints[i], b.waypoints[i]);
  CHECK(different == 0);
  REQUIRE(a.failure.has_value() == b.failure.has_value());
  if (!a.failure) return;
  CHECK(a.failure->exit == b.failure->exit);
  CHECK(a.failure->line == b.failure->line);
  CHECK(a.failure->what == b.failure->what);
}

}  // namespace counterflex::test
