// The best constant shift: minimised over a few places, checked against all.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "compensation/shift/commands.hpp"
#include "compensation/shift/minimax.hpp"
#include "compensation/solve/solver.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

constexpr double same = 1e-8;    // m: largest deviations that differ by less are the same
constexpr int most_passes = 12;  // over the program
constexpr double step = 1e-4;    // m: of a difference quotient
// What a shift as large as the largest deviation costs, in shares of it: it settles shifts on which nothing
// depends. A tool is changed only where a work offset does not do the same: with the cost of a shift, shifts
// of 3 programs of 17 change by up to 3 µm.
constexpr double shift_cost = 0.5e-6, tool_cost = 0.5e-3;
// What a turn of 1 rad costs, likewise: a turn about the path itself changes little but turns the tool.
constexpr double turn_cost = 15;

// The variables: of each work offset its shift and, in units of m at its edge, its turn; lengths and radii of
// tools.
struct Variables {
  const ShiftFreedom& freedom;
  std::vector<Vector3> centre{};           ///< by offset: what it is turned about
  std::vector<double> edge{};              ///< by offset: how far its places are from there (m)
  std::map<long, int> lengths{}, radii{};  ///< by tool: its variable
  std::vector<std::size_t> part{};         ///< by offset: offsets of the same number share tools
  int count = 0;

  int each() const { return freedom.turns ? 6 : 3; }
  int first_of(std::size_t offset) const { return static_cast<int>(offset) * each(); }
};

// Numbers offsets with common tools alike, and gives all tools but the first of a part a length.
void add_tools(const ShiftPlaces& places, Variables& v) {
  v.part.resize(v.freedom.offsets);
  std::iota(v.part.begin(), v.part.end(), std::size_t{0});
  const auto& pairs = places.pairs();
  for (const auto& [offset, tool] : pairs)
    for (const auto& [other, its_tool] : pairs) {
      if (tool != its_tool || v.part[offset] == v.part[other]) continue;
      const std::size_t from = v.part[other], to = v.part[offset];
      std::replace(v.part.begin(), v.part.end(), from, to);
    }
  std::set<std::size_t> has_first;
  for (const long tool : places.tools()) {
    const auto used =
        std::find_if(pairs.begin(), pairs.end(), [&](const auto& p) { return p.second == tool; });
    const bool is_first = has_first.insert(v.part[used->first]).second;
    if (v.freedom.lengths && !is_first) v.lengths[tool] = v.count++;
    if (places.contours().contains(tool)) v.radii[tool] = v.count++;
  }
}

Variables variables_of(const ShiftFreedom& freedom, const ShiftPlaces& places) {
  Variables v{freedom};
  for (std::size_t offset = 0; offset < freedom.offsets; ++offset) {
    const ShiftPlaces::Box box = places.box(offset);
    const bool known = places.has(offset);
    v.centre.push_back(known ? Vector3(0.5 * (box.least + box.most)) : Vector3::Zero());
    v.edge.push_back(std::max(known ? 0.5 * (box.most - box.least).norm() : 0, 1e-3));
  }
  v.count = v.each() * static_cast<int>(freedom.offsets);
  add_tools(places, v);
  return v;
}

Pose offset_shift(const Variables& v, const Eigen::VectorXd& x, std::size_t offset) {
  const int first = v.first_of(offset);
  Pose shift{Matrix3::Identity(), x.segment<3>(first)};
  if (!v.freedom.turns) return shift;
  shift.R = exp_so3(x.segment<3>(first + 3) / v.edge[offset]);
  shift.p += v.centre[offset] - shift.R * v.centre[offset];
  return shift;
}

BestShift values_of(const Variables& v, const Eigen::VectorXd& x) {
  BestShift best;
  for (std::size_t offset = 0; offset < v.freedom.offsets; ++offset)
    best.offsets.push_back(offset_shift(v, x, offset));
  for (const auto& [tool, variable] : v.lengths) best.lengths[tool] = x[variable];
  for (const auto& [tool, variable] : v.radii) best.radii[tool] = x[variable];
  return best;
}

// A place with the derivatives of its deviation.
struct Row {
  ShiftPlace at;
  std::size_t offset = 0;
  MinimaxRow row{};
};

class Search {
 public:
  Search(const ShiftFreedom& freedom, const ShiftPlaces& first, int threads, const StartTables* starts)
      : v_(variables_of(freedom, first)),
        x_(Eigen::VectorXd::Zero(v_.count)),
        at_platform_(first.at_platform()),
        threads_(threads),
        starts_(starts) {
    add(first);
    for (std::size_t offset = 0; offset < freedom.offsets; ++offset)
      unshifted_ = std::max(unshifted_, largest(offset));
  }

  BestShift shift() const { return values_of(v_, x_); }

  /// Adds places that are larger than the largest one of their offset so far.
  void add(const ShiftPlaces& found) {
    std::vector<Row> rows;
    for (const ShiftPlace& place : found.places()) {
      const std::size_t offset = v_.freedom.offset_of_frame[place.frame];
      if (is_searched_ && place.deviation.norm() <= largest(offset)) continue;
      if (!known_.insert(place.number).second) continue;
      rows.push_back({place, offset});
    }
    differentiate(rows);
    rows_.insert(rows_.end(), std::make_move_iterator(rows.begin()), std::make_move_iterator(rows.end()));
  }

  /// Minimises over the places so far. Line of a place that cannot be solved, or 0.
  int minimise() {
    is_searched_ = true;
    if (!(unshifted_ > 0)) return 0;
    const std::set<std::size_t> parts(v_.part.begin(), v_.part.end());
    for (const std::size_t part : parts) {
      const auto of_part = [&](std::size_t offset) { return v_.part[offset] == part; };
      const auto offsets = std::ranges::count(v_.part, part);
      if (const int line = minimise(of_part, true)) return line;
      if (offsets == 1) continue;
      for (std::size_t one = 0; one < v_.part.size(); ++one)
        if (const int line =
                of_part(one) ? minimise([&](std::size_t offset) { return offset == one; }, false) : 0)
          return line;
    }
    return 0;
  }

  double largest(std::size_t offset) const {
    double largest = 0;
    for (const Row& row : rows_)
      if (row.offset == offset) largest = std::max(largest, row.row.r.norm());
    return largest;
  }

 private:
  // Deviations with the shift `x`; the line of the first place that cannot be solved, or 0.
  int solve(const std::vector<Row>& rows, const Eigen::VectorXd& x, std::vector<Vector3>& deviations) const {
    deviations.assign(rows.size(), Vector3::Zero());
    std::vector<int> failed(rows.size(), 0);
    const BestShift shift = values_of(v_, x);
    for_each_slice(rows.size(), threads_, [&](std::size_t begin, std::size_t count) {
      std::vector<TipPosition> positions;
      std::vector<ForwardRequest> requests;
      for (std::size_t i = begin; i < begin + count; ++i) {
        const Row& row = rows[i];
        const Pose& by = shift.offsets[row.offset];
        const Vector3 axis = tool_axis_at_home(*row.at.wanted.model);
        positions.push_back(row.at.wanted);
        requests.push_back({.model = row.at.wanted.model,
                            .target = by * row.at.command + length_of(shift.lengths, row.at.tool) * axis +
                                      length_of(shift.radii, row.at.tool) * row.at.away,
                            .F = row.at.F,
                            .directions = row.at.directions});
        if (row.at.wanted.R_MT) requests.back().R = by.R * *row.at.wanted.R_MT;
      }
      std::vector<WantedPose> wanted(count);
      std::vector<ForwardAnswer> answers(count);
      PlaceSolver solver(starts_, at_platform_);
      solver.wanted(positions, wanted, StopAt::end);
      solver.forwards(requests, answers, StopAt::end);
      for (std::size_t i = 0; i < count; ++i) {
        if (wanted[i].status == Status::converged && answers[i].status == Status::converged)
          deviations[begin + i] = answers[i].X_MT.p - wanted[i].X_MT.p;
        else
          failed[begin + i] = rows[begin + i].at.line;
      }
    });
    const auto first = std::ranges::find_if(failed, [](int line) { return line != 0; });
    return first == failed.end() ? 0 : *first;
  }

  // The variables on which a place depends: those of its offset are the first.
  void set_columns(Row& row) const {
    std::size_t count = 0;
    const auto add = [&](int variable) { row.row.column[count++] = variable; };
    for (int k = 0; k < v_.each(); ++k) add(v_.first_of(row.offset) + k);
    if (const auto length = v_.lengths.find(row.at.tool); length != v_.lengths.end()) add(length->second);
    if (const auto radius = v_.radii.find(row.at.tool); radius != v_.radii.end() && !row.at.away.isZero(0))
      add(radius->second);
    row.row.J.setZero(3, count);
  }

  // Difference quotients at the present shift. All places are solved with the k-th of their variables
  // changed.
  void differentiate(std::vector<Row>& rows) const {
    std::vector<Vector3> here, there;
    solve(rows, x_, here);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i].row.r = here[i];
      set_columns(rows[i]);
    }
    Eigen::VectorXd x = x_;
    for (int variable = 0; variable < v_.count; ++variable) {
      std::vector<Row> some;
      std::vector<std::pair<std::size_t, Eigen::Index>> of;
      for (std::size_t i = 0; i < rows.size(); ++i)
        for (Eigen::Index k = 0; k < rows[i].row.J.cols(); ++k)
          if (rows[i].row.column[k] == variable) {
            some.push_back(rows[i]);
            of.emplace_back(i, k);
          }
      if (some.empty()) continue;
      x[variable] = x_[variable] + step;
      solve(some, x, there);
      x[variable] = x_[variable];
      for (std::size_t k = 0; k < of.size(); ++k)
        rows[of[k].first].row.J.col(of[k].second) = (there[k] - here[of[k].first]) / step;
    }
  }

  // By variable, so that the cost of a change is in m.
  Eigen::VectorXd costs() const {
    Eigen::VectorXd costs = Eigen::VectorXd::Constant(v_.count, 2 * tool_cost / unshifted_);
    for (std::size_t offset = 0; offset < v_.freedom.offsets; ++offset) {
      const int first = v_.first_of(offset);
      costs.segment(first, v_.each()).setConstant(2 * shift_cost / unshifted_);
      if (v_.freedom.turns)
        costs.segment(first + 3, 3)
            .setConstant(2 * turn_cost * unshifted_ / (v_.edge[offset] * v_.edge[offset]));
    }
    return costs;
  }

  // Over the places of some offsets; with or without the variables of tools. Newton's method on the
  // linearised problem: the deviation is nearly linear.
  template <typename Takes>
  int minimise(const Takes& takes, bool tools) {
    constexpr int most_steps = 8;
    std::vector<std::size_t> chosen;
    std::vector<Row> some;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (takes(rows_[i].offset)) chosen.push_back(i), some.push_back(rows_[i]);
    if (some.empty()) return 0;
    std::map<int, int> local;  // variables of these places alone
    std::vector<int> global;
    for (Row& row : some) {
      const auto kept = tools ? row.row.J.cols() : v_.each();
      row.row.J = row.row.J.leftCols(kept).eval();
      for (Eigen::Index k = 0; k < kept; ++k) {
        int& column = row.row.column[k];
        const auto [found, is_new] = local.try_emplace(column, static_cast<int>(global.size()));
        if (is_new) global.push_back(column);
        column = found->second;
      }
    }
    const Eigen::VectorXd cost = costs()(global);
    for (int s = 0; s < most_steps; ++s) {
      std::vector<MinimaxRow> rows;
      for (const Row& row : some) rows.push_back(row.row);
      const Eigen::VectorXd dx = least_largest(rows, {cost, x_(global)});
      x_(global) += dx;
      std::vector<Vector3> deviations;
      if (const int line = solve(some, x_, deviations)) return line;
      double expected = 0, largest = 0;
      for (std::size_t i = 0; i < some.size(); ++i) {
        expected = std::max(expected, rows[i].at(dx).norm());
        some[i].row.r = deviations[i];
        largest = std::max(largest, deviations[i].norm());
      }
      if (std::abs(largest - expected) < 0.1 * same) break;
    }
    for (std::size_t i = 0; i < chosen.size(); ++i) rows_[chosen[i]].row.r = some[i].row.r;
    return 0;
  }

  Variables v_;
  Eigen::VectorXd x_;
  const bool at_platform_;
  const int threads_;
  const StartTables* starts_;
  std::vector<Row> rows_;
  std::set<std::size_t> known_;
  double unshifted_ = 0;  // m: the largest deviation without a shift
  bool is_searched_ = false;
};

}  // namespace

ConstantShift shift_of(const ShiftFreedom& freedom, const BestShift& best) {
  ConstantShift shift{{}, best.lengths, best.radii};
  for (const std::size_t offset : freedom.offset_of_frame) shift.frames.push_back(best.offsets[offset]);
  return shift;
}

BestShift best_shift(const ShiftFreedom& freedom, const ShiftPlaces& first, const ShiftPass& pass,
                     int threads, const StartTables* starts) {
  Search search(freedom, first, threads, starts);
  BestShift best;
  best.largest = HUGE_VAL;
  for (std::size_t passes = 1; passes <= most_passes; ++passes) {
    if (const int line = search.minimise())
      return {.failure = Failure{ErrorKind::not_compensated, line,
                                 "--offsets: this place cannot be solved with the shifted work offset"}};
    BestShift now = search.shift();
    ShiftPlaces found(freedom);
    now.failure = pass(shift_of(freedom, now), found);
    now.passes = passes;
    if (now.failure) return now;
    double least = 0, beyond = 0;
    for (std::size_t offset = 0; offset < freedom.offsets; ++offset) {
      now.largest = std::max(now.largest, found.largest(offset));
      least = std::max(least, search.largest(offset));
      beyond = std::max(beyond, found.largest(offset) - search.largest(offset));
    }
    if (now.largest < best.largest) best = now;
    best.passes = passes;
    best.gap = std::max(0.0, best.largest - least);
    if (beyond <= same) return best;
    search.add(found);
  }
  return best;
}

}  // namespace counterflex
