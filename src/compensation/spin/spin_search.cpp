#include "counterflex/compensation/spin_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compensation/solve/commands.hpp"
#include "compensation/spin/spin_path.hpp"
#include "compensation/spin/spin_rows.hpp"
#include "compensation/tuning.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

constexpr double rate = spin_step / between_stops;  // most turn for feed path (rad/m)
constexpr std::size_t places_together = 4096;       // whose rows are in memory

// Whether the correction can write another orientation at the end of the move.
bool can_be_turned(const Move& move) {
  return move.handling == Handling::own && !move.cycle && move.group == 0 && !move.relative &&
         !move.fixed[0] && !move.fixed[1] && !move.fixed[2] && takes_all_words(move) &&
         !(move.arc && move.arc->through && move.arc->through->turn_limits);
}

// What a control compares with the target. A line of ABB stops if the configuration differs (ConfL), those of
// FANUC and Yaskawa state full turns.
StatedTurns stated_turns_of(const Move& move, const std::string& dialect) {
  if (move.orientation->stated_turns != StatedTurns::none) return move.orientation->stated_turns;
  if (dialect == "abb") return StatedTurns::quadrants;
  if (dialect == "fanuc_tp" || dialect == "yaskawa") return StatedTurns::half_turns;
  return StatedTurns::none;
}

void refuse_form(const Job& job, const Move& move) {
  const auto refuse = [&](const char* why) {
    throw InputError(ErrorKind::program_text, {job.program.file, move.line, 1},
                     std::string("--free spin cannot turn this target: ") + why +
                         "; leave the option out, or take the program in the language of the robot");
  };
  if (move.orientation->form == OrientationForm::axis)
    refuse("the program gives the axis of the tool, and the post chooses the turn about it");
  if (move.orientation->by_angles)
    refuse(
        "the control changes A, B and C evenly between targets, so another turn would tilt the tool there");
}

// The stops and places of the windows so far.
struct SpinSearch {
  /// Of a move's end: its number in the program, and the fraction of the way to the stop at which it is.
  struct Node {
    std::size_t move = 0;
    double fraction = 1;
  };

  SpinGraph graph;
  std::vector<float> margins;  // as `graph.deviations`
  std::vector<Node> nodes;
  std::vector<std::size_t> nodes_end;  // by stop
  std::size_t moves = 0, targets = 0;  // so far
  bool linked = false;                 // the place before is a stop or a node
  Eigen::VectorXd counted;             // the actuators of the last place
  std::vector<SpinRequest> requests;   // of the places of the window

  // The way from the last stop.
  struct Stretch {
    std::vector<Node> nodes{};    // with the way in place of the fraction
    double way = 0, sampled = 0;  // m
    double tilting = 0;           // largest tilt times way of a segment (rad m)
    bool constant = false;
    std::size_t places = 0;            // with the way in place of the fraction
    std::size_t segment = no_segment;  // the last one
  } open;

  void add_request(const Job& job, std::size_t s, double u) {
    const Segment& segment = job.path.segments[s];
    const Move& move = job.program.moves[segment.move];
    const Vector3 wanted = point_at(segment.wanted, u);
    requests.push_back({.command = {.model = &model_of(job, segment),
                                    .target = original_command(job, segment.frame, wanted),
                                    .F = job.forces.at(s, u, Side::before),
                                    .directions = directions_at(job, segment.move, u, Side::before)},
                        .wanted = {*orientation_at(segment, u), wanted},
                        .turns = stated_turns_of(move, job.program.dialect)});
  }

  // A place of a segment, `way` behind the last stop.
  void add_place(const Job& job, std::size_t s, double u, double way) {
    add_request(job, s, u);
    graph.places.push_back({way, way - open.sampled});
    open.sampled = way;
    ++open.places;
  }

  void add_stop(SpinStop stop) {
    stop.places_end = graph.places.size();
    graph.stops.push_back(stop);
    nodes_end.push_back(nodes.size());
    open = {};
  }

  // The last node of the open way becomes a stop.
  void close(const Job& job, bool is_free = true) {
    if (open.nodes.empty()) {
      if (!is_free && !graph.stops.empty()) graph.stops.back().is_free = false;
      return;
    }
    if (open.segment == no_segment) {  // the tool stays at the last stop
      for (const Node& node : open.nodes) nodes.push_back({node.move, 1});
      nodes_end.back() = nodes.size();
      if (!is_free) graph.stops.back().is_free = false;
      open = {};
      return;
    }
    if (open.sampled < open.way || open.places == 0) {
      add_request(job, open.segment, 1);
      graph.places.push_back({open.way, open.way - open.sampled});
      ++open.places;
    }
    for (std::size_t k = graph.places.size() - open.places; k < graph.places.size(); ++k)
      graph.places[k].fraction = open.way > 0 ? graph.places[k].fraction / open.way : 1;
    for (const Node& node : open.nodes)
      nodes.push_back({node.move, open.way > 0 ? node.fraction / open.way : 1});
    add_stop({.linked = true, .is_free = is_free, .most_steps = most_steps(job.options.tilt_tolerance)});
  }

  // The axis of a turn that changes by `d` along a move whose axis tilts by `a` is off by a d / 8 in its
  // middle; the other half of the share is for what this leaves out.
  int most_steps(double tilt_tolerance) const {
    if (open.constant || open.way == 0) return 0;
    double most = rate * open.way;
    if (open.tilting > 0)
      most = std::min(most, 4 * spin_tilt_share * tilt_tolerance * open.way / open.tilting);
    return std::min(spin_count, static_cast<int>(most / spin_step * (1 + 1e-9)));
  }

  void add_move(const Job& job, std::size_t m, std::size_t s) {
    const Move& move = job.program.moves[m];
    if (move.orientation) refuse_form(job, move);
    if (!move.orientation || !all_known(move.known_end)) {
      close(job);
      linked = false;
      return;
    }
    ++targets;
    const bool can_turn = can_be_turned(move), starts_known = all_known(move.known_start);
    if (!starts_known) {
      close(job);
      add_first(job, m, can_turn);
      return;
    }
    if (move.starts_uncorrected || !linked) {
      close(job);
      add_stop({});  // as programmed
    }
    if (!can_turn) close(job, false);
    if (s == no_segment)  // it stays where it is
      open.nodes.push_back({moves + m, open.way});
    else if (move.motion == Motion::feed)
      add_feed(job, m, s);
    else
      add_rapid(job, m, s, can_turn);
    if (!can_turn) close(job, false);
    if (open.way >= between_stops) close(job);
    linked = true;
  }

  // A position that is reached from an unknown one.
  void add_first(const Job& job, std::size_t m, bool can_turn) {
    const Move& move = job.program.moves[m];
    requests.push_back({.command = {.model = &model_of(job, m),
                                    .target = target_of(job, move),
                                    .directions = directions_at(job, m, 1, Side::before)},
                        .wanted = {*orientation_of(job, move), wanted_of(job, move)},
                        .turns = stated_turns_of(move, job.program.dialect)});
    graph.places.push_back({});
    nodes.push_back({moves + m, 1});
    add_stop({.is_free = can_turn});
    linked = true;
  }

  // The robot goes there by its joints: any turn may follow any other.
  void add_rapid(const Job& job, std::size_t m, std::size_t s, bool can_turn) {
    close(job);
    add_request(job, s, 1);
    graph.places.push_back({});
    nodes.push_back({moves + m, 1});
    add_stop({.linked = true, .is_free = can_turn, .most_steps = spin_count});
  }

  void add_feed(const Job& job, std::size_t m, std::size_t s) {
    const Segment& segment = job.path.segments[s];
    const double way = length(segment.wanted);
    // What is not divided bends little between its ends only in one turn.
    const bool constant = segment.wanted.arc || !job.program.moves[m].may_split;
    if (constant != open.constant) close(job);
    open.constant = constant;
    const int parts = 1 + static_cast<int>(way / between_places);
    for (int k = 1; k <= parts; ++k) {
      const double u = static_cast<double>(k) / parts, at = open.way + u * way;
      if (at - open.sampled >= between_places / 2) add_place(job, s, u, at);
    }
    const Vector3 turn = rotation_between(*orientation_at(segment, 1), *orientation_at(segment, 0));
    open.tilting = std::max(open.tilting, way * tilt(turn, orientation_at(segment, 0)->col(2)).norm());
    open.way += way;
    open.segment = s;
    open.nodes.push_back({moves + m, open.way});
  }

  // The rows of the window's places, some thousand at a time.
  void solve(const Job& job) {
    for (std::size_t first = 0; first < requests.size(); first += places_together) {
      const auto some =
          std::span(requests).subspan(first, std::min(places_together, requests.size() - first));
      std::vector<SpinRow> rows = solve_rows(job, some);
      for (std::size_t i = 0; i < some.size(); ++i) {
        keep_travel(some[i], counted, rows[i]);
        graph.deviations.insert(graph.deviations.end(), rows[i].deviation.begin(), rows[i].deviation.end());
        margins.insert(margins.end(), rows[i].margin.begin(), rows[i].margin.end());
      }
    }
    requests.clear();
  }

  // The graph without turns that come closer to another configuration than the program does.
  SpinGraph allowed() const {
    constexpr float not_allowed = std::numeric_limits<float>::infinity();
    constexpr float rounding = 1e-5F;
    SpinGraph result = graph;
    float least = not_allowed;
    for (std::size_t i = spin_zero; i < margins.size(); i += spin_count) least = std::min(least, margins[i]);
    for (std::size_t i = 0; i < margins.size(); ++i)
      if (i % spin_count != spin_zero && margins[i] < least * (1 - rounding))
        result.deviations[i] = not_allowed;
    return result;
  }

  // The next window.
  void add(const Job& job) {
    std::size_t next = 0;
    const std::vector<Segment>& segments = job.path.segments;
    for (std::size_t m = 0; m < job.program.moves.size(); ++m) {
      const bool has_segment = next < segments.size() && segments[next].move == m;
      add_move(job, m, has_segment ? next++ : no_segment);
    }
    close(job);  // requests are those of the window
    moves += job.program.moves.size();
    solve(job);
  }

  SpinChoice best() const {
    const std::vector<int> turns = best_turns(allowed());
    SpinChoice choice{.at_end = std::vector<double>(moves, 0.0), .targets = targets};
    std::size_t n = 0;
    for (std::size_t i = 0; i < turns.size(); ++i) {
      const bool is_linked = graph.stops[i].linked;
      const int from = (is_linked ? turns[i - 1] : turns[i]) - spin_zero, to = turns[i] - spin_zero;
      for (; n < nodes_end[i]; ++n) {
        const double turn = (from + (to - from) * nodes[n].fraction) * spin_step;
        choice.at_end[nodes[n].move] = turn;
        choice.turned += turn != 0;
        choice.least = std::min(choice.least, turn);
        choice.most = std::max(choice.most, turn);
      }
    }
    return choice;
  }
};

}  // namespace

SpinChoice best_spins(JobWindows& windows, int threads, const std::function<void(const Job&)>& read) {
  SpinSearch search;
  JobWindow window;
  while (windows.next(window)) {
    Job job = windows.job(window);
    read(job);
    job.options.threads = threads;
    search.add(job);
  }
  return search.best();
}

}  // namespace counterflex
