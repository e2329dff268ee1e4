#include <fmt/format.h>

#include <algorithm>

#include "counterflex/forces/forces.hpp"
#include "forces/path/profile/position_log.hpp"
#include "forces/path/profile/profile_ends.hpp"
#include "forces/path/rules/coverage.hpp"
#include "forces/path/rules/program_kinds.hpp"
#include "forces/path/rules/rules_in_use.hpp"
#include "forces/read/selector_text.hpp"

namespace counterflex {
namespace {

/// Throws if forces act at the platform and at the tip: a mean over a step between them has no single place.
void refuse_two_places(const std::vector<ForceRule>& rules) {
  const auto find = [&](bool platform) {
    return std::find_if(rules.begin(), rules.end(), [&](const ForceRule& rule) {
      return at_platform(rule) == platform && !is_zero(rule);
    });
  };
  const auto platform = find(true), tip = find(false);
  if (platform == rules.end() || tip == rules.end()) return;
  fail_rule(*platform, fmt::format("acts at the platform, but {} acts at the tip; one run has its forces at "
                                   "one of the two places",
                                   place_of(*tip, tip->where)));
}

/// Whether every move is covered: no rules, or one rule for the whole program.
bool covers_everything(const std::vector<ForceRule>& rules) {
  return rules.empty() || (rules.size() == 1 && rank(rules[0]) == ForceRank::program);
}

bool is_log(const ForceRule& rule) {
  const auto* profile = std::get_if<ForceProfile>(&rule.content);
  return profile != nullptr && profile->key == ForceKey::point;
}

}  // namespace

struct ForceCover::State {
  enum class Stage { places_of_points, far_point, cover, done };

  explicit State(ForceSource& s) : source(s), kinds(s.rules), in_use(s) {
    for (ForceRule& rule : source.rules)
      if (is_log(rule)) logs.emplace_back(std::get<ForceProfile>(rule.content));
    stage = !logs.empty() ? Stage::places_of_points : Stage::cover;
    if (covers_everything(source.rules)) stage = Stage::done;
    if (stage == Stage::cover) begin_cover();
  }

  void begin_cover() {
    stage = Stage::cover;
    for (const ForceRule& rule : source.rules) {
      if (const auto* profile = std::get_if<ForceProfile>(&rule.content)) {
        profiles.push_back(&rule);
        profile_ends.emplace_back(*profile);
      }
      if (at_platform(rule) && !is_zero(rule)) platform = &rule;
    }
  }

  /// Called after the pass that has found the places of the path near the logged positions.
  void place_points() {
    for (PositionLog& log : logs)
      if (!far) far = log.far_point();
    if (far) {
      stage = Stage::far_point;
      return;
    }
    for (PositionLog& log : logs) log.settle();
    logs.clear();
    begin_cover();
  }

  void cover(const Program& window, const Toolpath& path) {
    kinds.add(window);
    in_use.add(window, path);
    ends.add(window, path);
    file = window.file;
    Coverage coverage(source, window, path, block_number);
    for (std::size_t i = 0; i < path.segments.size(); ++i) {
      const Segment& segment = path.segments[i];
      const Move& move = window.moves[segment.move];
      if (segment.cutting && !in_air(source, move)) cover_segment(coverage, i, segment, move);
    }
    // A hole needs no rule, but must not have two.
    for (std::size_t m = 0; m < window.moves.size(); ++m)
      if (drills(window.moves[m]) && !in_air(source, window.moves[m]))
        cover_hole(coverage, m, window.moves[m]);
  }

  void cover_segment(Coverage& coverage, std::size_t i, const Segment& segment, const Move& move) {
    refuse_comment_beside_platform(move);
    if (!move.force)
      for (std::size_t k = 0; k < profiles.size(); ++k)
        profile_ends[k].add(coverage.keys(*profiles[k], i), segment);
    const auto nothing = [](const ForceStretch& stretch) {
      return stretch.rule == nullptr && !stretch.comment;
    };
    const std::vector<ForceStretch>& stretches = coverage.stretches(i);
    if (std::none_of(stretches.begin(), stretches.end(), nothing)) return;
    if (uncovered++ == 0) first_uncovered = segment.line;
  }

  void cover_hole(Coverage& coverage, std::size_t m, const Move& move) const {
    refuse_comment_beside_platform(move);
    coverage.hole(m);
  }

  void refuse_comment_beside_platform(const Move& move) const {
    if (platform != nullptr && move.force && !move.force->isZero(0))
      fail_rule(*platform, fmt::format("acts at the platform, but the FORCE comment for line {} acts at the "
                                       "tip; one run has its forces at one of the two places",
                                       move.line));
  }

  void check() const {
    kinds.refuse_unknown(source);
    for (const ProfileEnds& of_profile : profile_ends) of_profile.refuse_rows_beyond(ends);
    refuse_ranges_beyond();
    in_use.refuse_idle();
    if (source.rules.size() == 1 && !profile_ends.empty()) profile_ends[0].refuse_missing_ends(ends);
    if (uncovered == 0) return;
    const std::string moves = uncovered > 1 ? fmt::format(" and {} more have", uncovered - 1) : " has";
    throw InputError(
        ErrorKind::machine_or_force, {file, first_uncovered, 1},
        fmt::format("this feed move{} no force: add a row or section for it, with zeros where nothing is "
                    "cut, or give --force=0,0,0 for all moves without another force",
                    moves));
  }

  void refuse_ranges_beyond() const {
    for (const ForceRule& rule : source.rules)
      for (const bool by_line : {true, false}) {
        const auto& range = by_line ? rule.selector.lines : rule.selector.blocks;
        const double last = ends.last(by_line ? ForceKey::line : ForceKey::block_number);
        if (range && static_cast<double>((*range)[0]) > last)
          fail_rule(rule, fmt::format("{} {} to {} are beyond the end of the program at {} {}",
                                      by_line ? "lines" : "blocks", (*range)[0], (*range)[1],
                                      by_line ? "line" : "block", last));
      }
  }

  ForceSource& source;
  Stage stage = Stage::done;
  std::vector<PositionLog> logs;
  std::optional<FarPoint> far;
  ProgramKinds kinds;
  RulesInUse in_use;
  ProgramEnds ends;
  std::vector<const ForceRule*> profiles;
  std::vector<ProfileEnds> profile_ends;  ///< of each profile
  const ForceRule* platform = nullptr;    ///< a rule that acts at the platform
  std::optional<long> block_number;
  std::size_t uncovered = 0;  ///< feed moves without a force, and the line of the first
  int first_uncovered = 0;
  std::string file;
};

ForceCover::ForceCover(ForceSource& source) {
  refuse_two_places(source.rules);
  state_ = std::make_unique<State>(source);
}

ForceCover::~ForceCover() = default;

bool ForceCover::needs_pass() const {
  return state_->stage != State::Stage::done;
}

void ForceCover::add(const Program& window, const Toolpath& path) {
  switch (state_->stage) {
    case State::Stage::places_of_points:
      for (PositionLog& log : state_->logs) log.add(window, path);
      break;
    case State::Stage::far_point:
      state_->far->add(window, path);
      break;
    case State::Stage::cover:
      state_->cover(window, path);
      break;
    case State::Stage::done:
      break;
  }
}

void ForceCover::end_pass() {
  if (state_->stage == State::Stage::places_of_points) {
    state_->place_points();
  } else if (state_->stage == State::Stage::far_point) {
    state_->far->refuse();
  } else if (state_->stage == State::Stage::cover) {
    state_->check();
    state_->stage = State::Stage::done;
  }
}

}  // namespace counterflex
