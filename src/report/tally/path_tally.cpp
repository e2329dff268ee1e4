#include <algorithm>
#include <cmath>
#include <utility>

#include "counterflex/geometry/types.hpp"
#include "counterflex/report/run_tally.hpp"
#include "report/tally/causes.hpp"

namespace counterflex {
namespace {

constexpr double no_correction = 1e-12;  // m: rounding of coordinates that were moved to M and back
constexpr std::size_t worst_rows = 10;
constexpr std::size_t most_lines = 4096;

DeviationSample sample(const Waypoint& w, const Vector6& deviation, double weight) {
  return {deviation, w.direction, w.tool_axis, weight, w.line};
}

/// Of a deviation of the real machine, which has a band: not of a cause alone.
DeviationSample banded(const Waypoint& w, const Vector6& deviation, double weight) {
  DeviationSample result = sample(w, deviation, weight);
  if (w.covariance) result.covariance = &*w.covariance;
  return result;
}

void keep(Largest& largest, double length, int line) {
  if (largest.line == 0 || length / mm > largest.mm + indistinct_mm)
    largest.line = line;  // the first of equal values
  largest.mm = std::max(largest.mm, length / mm);
}

std::optional<double> band_mm_at(const Waypoint& w, const Vector6& deviation) {
  if (!w.covariance) return std::nullopt;
  return band(deviation.head<3>(), w.covariance->topLeftCorner<3, 3>()) / mm;
}

/// Whether `deviation` is the largest of its line so far. Keeps it with its place; keeps the first of equal
/// values.
bool keep_worst(double& largest_mm, WorstPlace& place, const Waypoint& w, const Vector6& deviation,
                std::int32_t operation) {
  const double here_mm = deviation.head<3>().norm() / mm;
  if (place.known && here_mm <= largest_mm + indistinct_mm) {
    largest_mm = std::max(largest_mm, here_mm);
    return false;
  }
  largest_mm = here_mm;
  place = {true,      band_mm_at(w, deviation),  w.s / mm,        w.p_MT / mm,
           operation, w.wrench.head<3>().norm(), w.corrected_line};
  return true;
}

void keep_at_worst(const Waypoint& w, Measures& measures) {
  const double size_mm = w.before.head<3>().norm() / mm;
  if (measures.worst_mm >= 0 && size_mm <= measures.worst_mm + indistinct_mm) return;
  measures.worst_mm = size_mm;
  measures.at_worst.reset();
  if (w.causes) measures.at_worst = sources_at(w, *w.causes);
}

void count_without_causes(const Waypoint& w, UnknownCauses& without) {
  if (++without.places == 1) without.first_line = w.line;
}

DeviationParts parts_of(const Waypoint& w, const Causes& causes) {
  const auto size_mm = [](const Vector6& deviation) { return deviation.head<3>().norm() / mm; };
  DeviationParts parts{.discrepancy_mm = size_mm(w.before - causes.superposition)};
  for (const Cause& cause : all_causes) parts.*cause.size_mm = size_mm(cause.of(causes));
  return parts;
}

bool before_line(const WorstRow& row, int line) {
  return row.line < line;
}

}  // namespace

SourcesAtWorst sources_at(const Waypoint& w, const Causes& causes) {
  const auto in_mm = [](const Vector6& deviation) { return Vector3(deviation.head<3>() / mm); };
  SourcesAtWorst at{.line = w.line,
                    .place_mm = w.p_MT / mm,
                    .superposition_mm = in_mm(causes.superposition),
                    .before_mm = in_mm(w.before)};
  for (const Cause& cause : all_causes) at.*cause.at_worst_mm = in_mm(cause.of(causes));
  return at;
}

// Nearly all lines are in order: the wanted one is the last one, or after it.
WorstRow& WorstLines::row(int line) {
  const auto place = [&] {
    if (rows_.empty() || rows_.back().line < line) return rows_.end();
    return std::lower_bound(rows_.begin(), rows_.end(), line, before_line);
  };
  auto found = place();
  if (found == rows_.end() || found->line != line) {
    if (rows_.size() >= most_lines) {
      keep_the_worst();
      found = place();
    }
    found = rows_.insert(found, WorstRow{.line = line});
  }
  if (line != last_) last_but_one_ = std::exchange(last_, line);
  return *found;
}

std::vector<WorstRow> WorstLines::worst(double WorstRow::*key) const {
  std::vector<WorstRow> rows(std::min(rows_.size(), worst_rows));
  const auto size = [&](const WorstRow& row) { return std::round(row.*key / indistinct_mm); };
  const auto worse = [&](const WorstRow& a, const WorstRow& b) {
    return size(a) > size(b) || (size(a) == size(b) && a.line < b.line);
  };
  std::partial_sort_copy(rows_.begin(), rows_.end(), rows.begin(), rows.end(), worse);
  return rows;
}

// The last line may still grow: everything of a piece except `after` is known at its end.
void WorstLines::keep_the_worst() {
  std::vector<int> lines{last_, last_but_one_};
  for (const auto key : {&WorstRow::before_mm, &WorstRow::after_mm})
    for (const WorstRow& row : worst(key)) lines.push_back(row.line);
  std::erase_if(rows_, [&](const WorstRow& row) {
    return std::find(lines.begin(), lines.end(), row.line) == lines.end();
  });
}

void PathTally::add(const Waypoint& w, std::int32_t operation, const MoveFacts& facts, bool is_within) {
  if (w.status != Status::converged) return;
  if (!w.between) add_target(w, facts.is_own);
  if (!w.cutting) finish_end();
  if (w.cutting || facts.is_hole) add_cutting(w, operation, facts, is_within);
  if (!w.cutting) finish_end();
}

Measures PathTally::measures() const {
  PathTally whole = *this;
  whole.finish_end();
  return std::move(whole.m_);
}

std::vector<WorstRow> PathTally::worst(double WorstRow::*key) const {
  PathTally whole = *this;
  whole.finish_end();
  return whole.lines_.worst(key);
}

std::vector<OperationTally> PathTally::operations() const {
  PathTally whole = *this;
  whole.finish_end();
  return std::move(whole.operations_);
}

void PathTally::add_target(const Waypoint& w, bool is_own) {
  const double length = w.correction.head<3>().norm();
  keep(m_.correction, length, w.line);
  const std::pair move{std::size_t{w.move}, w.line};
  if (!is_own || length < no_correction || last_changed_ == move) return;
  last_changed_ = move;
  ++m_.segments_changed;
}

void PathTally::add_cutting(const Waypoint& w, std::int32_t operation, const MoveFacts& facts,
                            bool is_within) {
  m_.after.add(banded(w, w.after, w.weight));
  tally_of(facts.tool).after.add(facts.tool, w.after, w.tool_axis, w.line);
  m_.path_mm += w.weight / mm;
  m_.largest_N = std::max(m_.largest_N, w.wrench.head<3>().norm());
  m_.largest_Nm = std::max(m_.largest_Nm, w.wrench.tail<3>().norm());
  add_to_operation(w, operation);
  WorstRow& row = lines_.row(w.line);
  keep_worst(row.after_mm, row.at_after, w, w.after, operation);
  piece_weight_ += w.weight;
  piece_missed_ = piece_missed_ || !is_within;
  piece_refused_ = piece_refused_ || !(is_within || w.insignificant);
  if (!w.between) close_piece(w, operation);
  place_weight_ += w.weight;
  if (w.place) add_place(w, operation, facts);
}

// An inserted point is not a place of the original path: only the causes at the emitted target count.
void PathTally::close_piece(const Waypoint& w, std::int32_t operation) {
  const double corrected_mm = std::exchange(piece_missed_, false) ? 0 : piece_weight_ / mm;
  m_.corrected_mm += corrected_mm;
  if (!std::exchange(piece_refused_, false)) m_.accepted_mm += piece_weight_ / mm;
  if (OperationTally* tally = tally_of(operation)) tally->corrected_mm += corrected_mm;
  piece_weight_ = 0;
  if (w.place || !w.causes) return;
  m_.without_force.add(sample(w, w.causes->air, 0));
  keep(m_.air, w.causes->air.head<3>().norm(), w.line);
}

ToolTally& PathTally::tally_of(const ToolSize& tool) {
  ToolTally& tally = m_.tools[tool.number];
  tally.size = tool;
  return tally;
}

OperationTally* PathTally::tally_of(std::int32_t operation) {
  if (operation == no_operation) return nullptr;
  const auto index = static_cast<std::size_t>(operation);
  if (index >= operations_.size()) operations_.resize(index + 1);
  return &operations_[index];
}

void PathTally::add_to_operation(const Waypoint& w, std::int32_t operation) {
  OperationTally* tally = tally_of(operation);
  if (tally == nullptr) return;
  tally->after.add(banded(w, w.after, w.weight));
  tally->length_mm += w.weight / mm;
  tally->first_line = tally->first_line == 0 ? w.line : std::min(tally->first_line, w.line);
  tally->last_line = std::max(tally->last_line, w.line);
  const std::pair move{w.segment, w.line};
  if (tally->last_move == move) return;
  tally->last_move = move;
  ++tally->moves;
}

// Trapezoidal rule: the length between two places counts half for each, or fully for the last one if the
// other is unknown. It is zero where a feed run begins, and between the two places of a step.
void PathTally::add_place(const Waypoint& w, std::int32_t operation, const MoveFacts& facts) {
  const double share = end_ ? place_weight_ / 2 : 0;
  if (end_ && place_weight_ > 0) share_piece(w, operation, share);
  finish_end();
  const double rest = place_weight_ - share;
  end_ = End{w, operation, rest, rest, facts};
  place_weight_ = 0;
}

// The first piece of an operation starts at the end of the previous one.
void PathTally::share_piece(const Waypoint& w, std::int32_t operation, double share) {
  end_->weight += share;
  OperationTally* tally = tally_of(operation);
  if (end_->operation == operation || tally == nullptr) return void(end_->weight_there += share);
  Waypoint start = end_->at;
  start.line = w.line;
  start.direction = w.direction;
  tally->before.add(banded(start, start.before, share));
}

void PathTally::finish_end() {
  if (end_) measure_end(*end_);
  end_.reset();
}

void PathTally::measure_causes(const Waypoint& w, const Causes& causes, double weight) {
  for (const Cause& cause : all_causes) (m_.*cause.tally).add(sample(w, cause.of(causes), weight));
  m_.superposition.add(sample(w, causes.superposition, weight));
  m_.without_force.add(sample(w, causes.air, weight));
  keep(m_.air, causes.air.head<3>().norm(), w.line);
}

void PathTally::measure_end(const End& end) {
  const Waypoint& w = end.at;
  m_.before.add(banded(w, w.before, end.weight));
  Vector6 rest = w.before;
  rest.head<3>() -= end.facts.common_shift;
  m_.rest.add(banded(w, rest, end.weight));
  tally_of(end.facts.tool).before.add(end.facts.tool, w.before, w.tool_axis, w.line);
  if (OperationTally* tally = tally_of(end.operation))
    tally->before.add(banded(w, w.before, end.weight_there));
  keep_at_worst(w, m_);
  w.causes ? measure_causes(w, *w.causes, end.weight) : count_without_causes(w, m_.without_causes);
  WorstRow& row = lines_.row(w.line);
  if (!keep_worst(row.before_mm, row.at_before, w, w.before, end.operation)) return;
  row.causes.reset();
  if (w.causes) row.causes = parts_of(w, *w.causes);
}

}  // namespace counterflex
