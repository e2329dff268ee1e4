#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "commands/check.hpp"
#include "commands/check_plan.hpp"
#include "counterflex/compensation/loads_along.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/sanity/checks.hpp"
#include "counterflex/toolpath/reach.hpp"
#include "run/program_axes.hpp"
#include "run/sanity.hpp"
#include "run/work.hpp"

namespace counterflex::cli {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// Sums over the moves of a program; lengths in mm, program coordinates.
struct MoveFacts {
  std::size_t rapids = 0, feeds = 0, cycles = 0, without_feed = 0, with_force = 0;
  std::size_t uncounted = 0;  ///< blocks that cut by a cycle, whose length is not in that of the feed moves
  Vector3 least = Vector3::Constant(inf), most = Vector3::Constant(-inf);
  double slowest = inf, fastest = 0;  ///< mm/min
  std::vector<std::string> offsets;
  std::vector<LengthUnit> units;
};

template <typename T>
void add_once(std::vector<T>& list, const T& value) {
  if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

void add_move(const Program& program, const Move& move, MoveFacts& facts) {
  const bool cuts_by_cycle = count_of_holes(move) > 0 || move.makes_hole || move.mills_at_end;
  if (moves_tool(move))
    ++(move.cycle || cuts_by_cycle ? facts.cycles : move.motion == Motion::feed ? facts.feeds : facts.rapids);
  facts.uncounted += cuts_by_cycle;
  const bool whole_way = move.arc && all_known(move.known_start) && all_known(move.known_end);
  const Extent extent = whole_way ? extent_of(move) : Extent{move.end_mm, move.end_mm};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    if (!move.known_end[axis]) continue;
    facts.least[i] = std::min(facts.least[i], extent.least[i]);
    facts.most[i] = std::max(facts.most[i], extent.most[i]);
  }
  for (const Vector3& p_mm : places_of_cycle(move)) {
    facts.least.z() = std::min(facts.least.z(), p_mm.z());
    facts.most.z() = std::max(facts.most.z(), p_mm.z());
  }
  add_once(facts.offsets, program.frames[move.frame].work_offset);
  add_once(facts.units, move.unit);
  facts.with_force += move.force.has_value();
  if (move.motion != Motion::feed) return;
  facts.without_feed += move.feed_mm_min <= 0;
  if (move.feed_mm_min <= 0) return;
  facts.slowest = std::min(facts.slowest, move.feed_mm_min);
  facts.fastest = std::max(facts.fastest, move.feed_mm_min);
}

/// Facts of a program, collected window by window.
struct ProgramFacts {
  Overview overview;
  MoveFacts moves;
  MotionPlanner planner;
  bool corrected = false;
  PathEnd end;
  std::size_t untimed = 0;  ///< feed moves of a known length or turn without a known feed or time
};

/// The length or the time of cutting: a sum, which is a lower bound if a part of it is not known.
struct CutAmount {
  double known = 0;
  bool is_complete = true;

  bool is_unknown() const { return !is_complete && known == 0; }
  std::string text(std::string_view what, std::string_view unit) const {
    if (is_unknown()) return fmt::format("unknown {}", what);
    return fmt::format("{}{:.6g} {}", is_complete ? "" : "at least ", known, unit);
  }
  nlohmann::ordered_json json() const {
    if (is_unknown()) return nullptr;
    return known;
  }
};

struct CutFacts {
  CutAmount mm, s;
};

CutFacts cut_facts(const ProgramFacts& facts) {
  const bool all_lengths = unknown_moves(facts.planner.plan()) == 0 && facts.moves.uncounted == 0;
  return {{facts.end.s / mm, all_lengths}, {facts.end.t, all_lengths && facts.untimed == 0}};
}

ProgramFacts facts_of(ProgramReader reader) {
  ProgramFacts facts;
  for (bool first = true; reader.next(); first = false) {
    const Program& window = reader.window();
    if (first) facts.corrected = is_corrected(window);
    add_window(facts.overview, window);
    facts.planner.add(window);
    for (const Move& move : window.moves) add_move(window, move, facts.moves);
    const Toolpath path = build_toolpath(window, one_frame(window, {}), facts.end);
    for (const Segment& segment : path.segments)
      facts.untimed += segment.cutting && (segment.s_end > segment.s_start || turn_of(segment) > 0) &&
                       segment.t_end == segment.t_start;
    facts.end = path.end;
  }
  return facts;
}

std::string units_text(const MoveFacts& facts) {
  std::string text;
  for (const LengthUnit unit : facts.units) {
    text += text.empty() ? "" : " and ";
    text += unit == LengthUnit::inches ? "inch" : unit == LengthUnit::metres ? "m" : "mm";
  }
  return text.empty() ? "not stated by any move" : text;
}

std::string feeds_text(const MoveFacts& facts) {
  std::string text = facts.fastest == 0
                         ? "none known"
                         : fmt::format("{:.6g} to {:.6g} mm/min", facts.slowest, facts.fastest);
  if (facts.without_feed > 0) text += fmt::format("; {} feed moves without a known feed", facts.without_feed);
  return text;
}

std::string extents_text(const MoveFacts& facts) {
  std::string text;
  for (int i = 0; i < 3; ++i) {
    text += fmt::format("{}{} ", i == 0 ? "" : ", ", "XYZ"[i]);
    text += facts.least[i] > facts.most[i] ? "unknown"
                                           : fmt::format("{:.6g} to {:.6g}", facts.least[i], facts.most[i]);
  }
  return text + " mm";
}

std::string offsets_text(const MoveFacts& facts) {
  std::string text;
  for (const std::string& offset : facts.offsets) {
    text += text.empty() ? "" : ", ";
    text += offset.empty() ? "none selected" : offset;
  }
  return text.empty() ? "none selected" : text;
}

std::string language_text(const std::string& dialect) {
  const std::string_view language = robot_language_of(dialect);
  return language.empty() ? "dialect " + dialect : fmt::format("{}, dialect {}", language, dialect);
}

nlohmann::ordered_json language_json(const std::string& dialect) {
  const std::string_view language = robot_language_of(dialect);
  return language.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(std::string(language));
}

std::string text_of(const ProgramFacts& facts) {
  const Overview& program = facts.overview;
  const MoveFacts& moves = facts.moves;
  std::string text = row("file", program.file) + row("program", language_text(program.dialect));
  text += row("units", units_text(moves));
  const bool robot = is_robot_dialect(program.dialect);
  text += row(
      robot ? "statements" : "blocks",
      fmt::format("{}, of them {} moves: {} feeds, {} rapids{}", program.blocks, program.moves, moves.feeds,
                  moves.rapids, moves.cycles > 0 ? fmt::format(", {} with a cycle", moves.cycles) : ""));
  const CutFacts cut = cut_facts(facts);
  text += row("cutting", fmt::format("{}, {}{}", cut.mm.text("length", "mm"), cut.s.text("time", "s"),
                                     cut.s.is_unknown() ? "" : " at programmed feeds"));
  text += row("feeds", feeds_text(moves));
  text += row("extents", extents_text(moves));
  text += row(robot ? "frames" : "offsets", offsets_text(moves));
  if (moves.with_force > 0)
    text += row("forces", fmt::format("FORCE comments act on {} moves", moves.with_force));
  if (program.zones.count > 0) text += row("zones", zones_in_words(program.zones));
  if (facts.corrected) text += row("header", "COUNTERFLEX 1: a corrected program, not compensated again");
  text += plan_text(facts.planner.plan());
  if (!program.remarks.empty()) text += "\nremarks\n";
  for (const Remark& remark : program.remarks)
    text += fmt::format("  line {:<6} {}\n", remark.line, remark.what);
  return text;
}

nlohmann::ordered_json extent_json(double value) {
  if (!std::isfinite(value)) return nullptr;
  return value;
}

nlohmann::ordered_json json_of(const ProgramFacts& facts) {
  const Overview& program = facts.overview;
  const MoveFacts& moves = facts.moves;
  const CutFacts cut = cut_facts(facts);
  nlohmann::ordered_json json{{"file", program.file},
                              {"kind", "program"},
                              {"dialect", program.dialect},
                              {"language", language_json(program.dialect)},
                              {"units", units_text(moves)},
                              {"corrected", facts.corrected},
                              {"blocks", program.blocks},
                              {"moves", program.moves},
                              {"feeds", moves.feeds},
                              {"rapids", moves.rapids},
                              {"cycle_moves", moves.cycles},
                              {"cutting_mm", cut.mm.json()},
                              {"cutting_mm_is_complete", cut.mm.is_complete},
                              {"cutting_s", cut.s.json()},
                              {"cutting_s_is_complete", cut.s.is_complete},
                              {"offsets", moves.offsets}};
  auto& extents = json["extents_mm"] = nlohmann::ordered_json::object();
  for (int i = 0; i < 3; ++i)
    extents[std::string(1, "xyz"[i])] = {extent_json(moves.least[i]), extent_json(moves.most[i])};
  json["plan"] = plan_json(facts.planner.plan());
  json["left_alone_count"] = program.left_alone.count;
  json["machine_positions_count"] = program.machine_positions.count;
  json["left_alone"] = json["machine_positions"] = json["remarks"] = nlohmann::ordered_json::array();
  for (const LeftAlone& block : program.left_alone.rows)
    json["left_alone"].push_back({{"line", block.line}, {"why", block.why}});
  for (const LeftAlone& block : program.machine_positions.rows)
    json["machine_positions"].push_back({{"line", block.line}, {"why", block.why}});
  for (const Remark& remark : program.remarks)
    json["remarks"].push_back({{"line", remark.line}, {"what", remark.what}});
  return json;
}

/// Goes with the nominal machine to the places of a program. `base`: the machine without a tool.
class PlacesReached {
 public:
  PlacesReached(const Model& base, const ToolModels& tools, const std::vector<WorkFrame>& frames)
      : base_(base), tools_(tools), frames_(frames), nominal_(base) {}

  /// Why a place of the window is not reached: an end of a line, a place on an arc, the bottom or the
  /// retract plane of a cycle.
  std::optional<Failure> add(const Program& window) {
    const std::vector<Segment> segments = build_toolpath(window, frames_).segments;
    std::size_t next = 0;
    for (std::size_t m = 0; m < window.moves.size(); ++m) {
      const Move& move = window.moves[m];
      if (goes_to_unknown_places(move)) travel_.skip(move.line);
      const bool has_segment = next < segments.size() && segments[next].move == m;
      if (has_segment)
        if (auto failure = go_along(segments[next++], window, move)) return failure;
      for (const Vector3& p_mm : places_of_cycle(move))
        if (auto failure = go_to(wanted_frame(frames_[move.frame]) * (p_mm * mm), {}, window, move))
          return failure;
    }
    return std::nullopt;
  }

  const TravelTally& travel() const { return travel_; }

 private:
  std::optional<Failure> go_along(const Segment& segment, const Program& window, const Move& move) {
    for (const double u : fractions_along(segment.wanted))
      if (u > 0)
        if (auto failure = go_to(point_at(segment.wanted, u), orientation_at(segment, u), window, move))
          return failure;
    return std::nullopt;
  }

  std::optional<Failure> go_to(const Vector3& p_M, const std::optional<Matrix3>& R_M, const Program& window,
                               const Move& move) {
    const Model& model = model_with(base_, &tools_, move.tool);
    const Status status = nominal_.go_to(model, p_M, R_M);
    if (status != Status::converged)
      return Failure{
          ErrorKind::not_compensated, move.line,
          fmt::format("the machine does not reach ({:.7g}, {:.7g}, {:.7g}) mm of its frame, to which "
                      "this block goes: {}",
                      p_M.x() / mm, p_M.y() / mm, p_M.z() / mm, to_string(status)),
          0, status};
    const Eigen::VectorXd rho = actuator_values(model.mechanism, nominal_.configuration());
    if (within_travel(model.mechanism, rho)) {
      travel_.add(model.mechanism, rho, move.line);
      return std::nullopt;
    }
    if (const auto word = ambiguous_integer_word(window, move.line))
      return Failure{ErrorKind::program_text, word->line, word->what};
    const CommandedPlace at{model, frames_[move.frame], move.tool, p_M, R_M, rho};
    return Failure{ErrorKind::limit, move.line, outside_travel_words(base_.mechanism, at), 0,
                   Status::outside_travel};
  }

  const Model& base_;
  const ToolModels& tools_;
  const std::vector<WorkFrame>& frames_;
  NominalToolPath nominal_;
  TravelTally travel_;
};

/// The first place that is not reached.
std::optional<Failure> first_unreached(ProgramReader reader, PlacesReached& places) {
  while (reader.next())
    if (auto failure = places.add(reader.window())) return failure;
  return std::nullopt;
}

void check_reach(const Overview& program, ProgramReader reader, MachineInput input,
                 const ToolLengths& lengths, Checked& checked, Console& console) {
  for (const Remark& warning : place_program_axes(program, input))
    console.warning(program.file, warning.line, warning.what);
  const WorkPlace work = place_work(input.machine, input.model, shown_name(input.file.path), program);
  for (const Remark& warning : work.assumptions) console.warning(program.file, warning.line, warning.what);
  const ToolModels tools = prepare_tools(input.machine, input.model, program.tools);
  PlacesReached places(input.model, tools, work.frames);
  const auto failure = first_unreached(std::move(reader), places);
  checked.json["reached"] = !failure;
  checked.text +=
      row("reach", failure ? fmt::format("line {}: {}", failure->line, failure->what)
                           : fmt::format("{} reaches the ends of all moves", shown_name(input.file.path)));
  SanityChecks sanity = program_sanity({input, tools, lengths, work, program});
  sanity.push_back(check_travel(input.model.mechanism, places.travel(), failure));
  add_sanity(sanity, input.machine, checked, console);
  if (!failure) return;
  checked.error_kind = failure->kind;
  console.error(located(program.file, *failure));
}

}  // namespace

Checked check_program(const std::string& path, const Options& options, const MachineInput* machine,
                      Console& console) {
  const Machine* of = machine != nullptr ? &machine->machine : nullptr;
  const ToolLengths lengths = read_tool_lengths(options, of);
  const ReadOptions read = read_options(options, of, lengths);
  const std::string name = shown_name(path);
  ProgramFile file = open_program("program", path, options.data_lists, console);
  try {
    const ProgramFacts facts = facts_of(ProgramReader(file.bytes, name, read));
    Checked checked{text_of(facts), "", json_of(facts)};
    if (machine != nullptr)
      check_reach(facts.overview, ProgramReader(file.bytes, name, read), *machine, lengths, checked, console);
    file.bytes.refuse_change();  // the file was read more than once
    return checked;
  } catch (const InputError&) {
    file.bytes.refuse_change();  // a file replaced while it was read has errors of its own
    throw;
  }
}

}  // namespace counterflex::cli
