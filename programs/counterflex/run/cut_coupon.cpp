#include "run/cut_coupon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <set>

#include "counterflex/machine/shown.hpp"
#include "counterflex/statics/fixture.hpp"
#include "run/windows.hpp"

namespace counterflex::cli {
namespace {

/// The events of a run that prints each note on forces once: every plunge of a coupon has the same one.
WindowEvents events_of(Windows& windows, const Run& run, Console& console, RunTally& tally, RunFiles& files,
                       std::set<std::string>& notes) {
  WindowEvents events = windows.events(tally, files);
  events.begun = [&](const Job& job) {
    const std::lock_guard alone(windows.speaking());
    for (const ForceNote& note : job.forces.notes())
      if (notes.insert(note.what).second) console.warning(run.program.file, note.line, note.what);
    tally.add_window(job);
  };
  return events;
}

/// The corrected program, and its blocks that the correction left as they are.
struct CorrectedText {
  std::string text;
  std::vector<LeftAlone> left_alone;
};

std::optional<Failure> correct(const Options& options, Run& run, Console& console, CorrectedText& corrected) {
  std::set<std::string> notes;
  RunFiles files(OutputPaths{}, {});
  RunTally tally = tally_for(options, run);
  Windows windows(run, console);
  WindowEvents events = events_of(windows, run, console, tally, files, notes);
  events.done = [&](const Job&, const Compensation& window) {
    corrected.text += window.text;
    corrected.left_alone.insert(corrected.left_alone.end(), window.left_alone.begin(),
                                window.left_alone.end());
  };
  return compensate_windows(windows.jobs(), run.options, TextReader(windows.reader()), false, events);
}

/// The header, the half that is not corrected from `original`, the other one from `corrected`.
std::string joined(const std::string& original, const std::string& corrected) {
  const std::string marker = fmt::format("{}\n", corrected_half);
  const std::size_t header = corrected.find(original.substr(0, original.find('\n') + 1));
  return corrected.substr(0, header) + original.substr(0, original.find(marker)) +
         corrected.substr(corrected.find(marker));
}

/// What the forward solution of the joined text shows.
struct Judgement {
  std::vector<Waypoint> places;    ///< of the original path
  Pose X_MW;                       ///< program coordinates in M
  std::optional<Failure> missed;   ///< first miss of the tolerance anywhere, as `verify_windows` finds it
  std::optional<Failure> failure;  ///< of the halves
};

void judge(const Job& job, const Coupon& coupon, const std::vector<Waypoint>& waypoints,
           Judgement& judgement) {
  constexpr double unchanged = 1e-9;  // m
  if (!judgement.missed) judgement.missed = tolerance_failure(job, waypoints);
  std::vector<Waypoint> corrected;
  for (const Waypoint& w : waypoints) {
    if (w.place) judgement.places.push_back(w);
    if (w.cutting) judgement.X_MW = wanted_frame(job.path.frames[job.path.segments[w.segment].frame]);
    if (w.line > coupon.first_corrected_line && w.cutting) corrected.push_back(w);
    if (w.line < coupon.first_corrected_line && !judgement.failure &&
        w.correction.head<3>().norm() > unchanged)
      judgement.failure =
          Failure{ErrorKind::not_compensated, w.line, "a move of the half that is not corrected has changed"};
  }
  if (!judgement.failure) judgement.failure = tolerance_failure(job, corrected);
}

std::optional<Failure> verify_coupon(const Options& options, Run& run, const Coupon& coupon,
                                     const std::string& text, Console& console, Judgement& judgement) {
  RunFiles files(OutputPaths{}, {});
  RunTally tally = tally_for(options, run);
  FileReader bytes = FileReader::of_bytes(text);
  ReadOptions read = run.read;
  read.dialect = run.program.dialect;
  ProgramReader corrected(bytes, run.program.file, read);
  Windows windows(run, console);
  WindowEvents events = windows.events(tally, files);
  events.begun = [](const Job&) {};  // its notes were printed
  events.solved = [&](const Job& job, const std::vector<Waypoint>& waypoints) {
    judge(job, coupon, waypoints, judgement);
  };
  const std::optional<Failure> failure =
      verify_windows(windows.jobs(), run.options.threads, corrected, false, events);
  if (judgement.failure) return judgement.failure;
  // A miss in the half that is not corrected is what the coupon is for.
  const bool is_miss = failure && judgement.missed && failure->line == judgement.missed->line &&
                       failure->what == judgement.missed->what && failure->line < coupon.first_corrected_line;
  return is_miss ? std::nullopt : failure;
}

/// Where the wanted place is under the force: the part deflects with its fixture.
Vector3 place_on_part(const Mechanism& mechanism, const Waypoint& w) {
  if (!mechanism.fixture) return w.p_MT;
  return deflected_part(*mechanism.fixture, w.wrench, w.p_MT) * w.p_MT;
}

/// Of each measured cut: its places, the first of a line being the end of the move before.
std::vector<CouponPlace> places_of(const Run& run, const Coupon& coupon,
                                   const std::vector<Waypoint>& waypoints) {
  std::set<int> lines, circles;
  for (const CouponQuantity& quantity : coupon.quantities)
    for (const CouponCut& cut : quantity.cuts)
      (quantity.fit == CouponFit::mean ? lines : circles).insert(cut.line);
  const Mechanism& mechanism = run.machine.model.mechanism;
  const long tool = run.tool_models.empty() ? 0 : run.tool_models.begin()->first;
  std::vector<CouponPlace> places;
  const auto add = [&](int line, const Waypoint& w) {
    places.push_back({line,
                      place_on_part(mechanism, w),
                      0,
                      {shown_values(mechanism.shown, w.rho), w.wrench, w.directions, {}, tool}});
  };
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const Waypoint& w = waypoints[i];
    if (circles.contains(w.line)) add(w.line, w);
    if (!lines.contains(w.line)) continue;
    const bool begins = i > 0 && waypoints[i - 1].line != w.line;
    if (begins) add(w.line, waypoints[i - 1]);
    add(w.line, w);
  }
  // A place represents the way to the middle between it and its neighbours.
  for (std::size_t i = 0; i < places.size(); ++i)
    for (const std::size_t other : {i - 1, i + 1})
      if (other < places.size() && places[other].line == places[i].line)
        places[i].way += (places[other].p_MT - places[i].p_MT).norm() / 2;
  return places;
}

}  // namespace

std::optional<Failure> cut_coupon(const Options& options, Run& run, const Coupon& coupon, Console& console,
                                  CutCoupon& cut) {
  CorrectedText corrected;
  if (auto failure = correct(options, run, console, corrected)) return failure;
  for (const LeftAlone& block : corrected.left_alone)
    if (block.line > coupon.first_corrected_line)
      return Failure{ErrorKind::not_compensated, block.line, "not corrected: " + block.why};
  cut.text = joined(coupon.text, corrected.text);
  Judgement judgement;
  if (auto failure = verify_coupon(options, run, coupon, cut.text, console, judgement)) return failure;
  cut.places = places_of(run, coupon, judgement.places);
  cut.X_MW = judgement.X_MW;
  return std::nullopt;
}

}  // namespace counterflex::cli
