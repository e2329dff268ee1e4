#include "program/robot/spacing.hpp"

#include <algorithm>
#include <array>

namespace counterflex {

const MoveEdit* edit_of(const std::vector<MoveEdit>& edits, std::size_t move) {
  const auto at = std::lower_bound(edits.begin(), edits.end(), move,
                                   [](const MoveEdit& edit, std::size_t m) { return edit.move < m; });
  return at != edits.end() && at->move == move ? &*at : nullptr;
}

std::vector<Vector3> written_points(const Move& move, const MoveEdit* edit, const WriteOptions& options) {
  if (edit == nullptr) return {move.end_mm};
  const Decimals decimals = decimals_of(move, options);
  const std::array<int, 3> inserted{decimals.inserted, decimals.inserted, decimals.inserted};
  std::vector<Vector3> points;
  if (edit->jump) points.push_back(as_written_mm(edit->jump->end_mm, move.unit, inserted));
  for (const Via& via : edit->inserted) points.push_back(as_written_mm(via.end_mm, move.unit, inserted));
  points.push_back(as_written_mm(edit->end_mm, move.unit, decimals.end));
  return points;
}

void limit_spacing(std::map<std::size_t, double>& spacings_mm, std::size_t move, double distance_mm) {
  const auto [at, is_new] = spacings_mm.try_emplace(move, distance_mm);
  if (!is_new) at->second = std::min(at->second, distance_mm);
}

std::map<std::size_t, double> spacing_at_targets(const Program& program, const std::vector<MoveEdit>& edits,
                                                 const WriteOptions& options) {
  std::map<std::size_t, double> spacings_mm;
  for (const MoveEdit& edit : edits) {
    const std::size_t m = edit.move;
    std::vector<Vector3> points = written_points(program.moves[m], &edit, options);
    if (points.size() < 2) continue;
    if (m > 0 && all_known(program.moves[m].known_start)) {
      const Vector3 start = written_points(program.moves[m - 1], edit_of(edits, m - 1), options).back();
      limit_spacing(spacings_mm, m - 1, distance_to_next(start, points));
      points.insert(points.begin(), start);
    }
    std::reverse(points.begin(), points.end());
    limit_spacing(spacings_mm, m, distance_to_next(points.front(), points));
  }
  return spacings_mm;
}

}  // namespace counterflex
