// What planning has found of the tip is taken for what is written, and for nothing else.
#include <fmt/format.h>

#include "gantry.hpp"
#include "window_stages.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

// A run of one window that is stopped before it is verified.
struct WrittenRun {
  explicit WrittenRun(const Order& order) : shop(in_lanes(order)), job(shop.job()) {
    CarriedState carried{Rewriter(job.options.write), TextReader(job.program, job.read)};
    begin_window(job, carried, work);
    plan_window(job, work);
    write_window(job, carried, work);
    REQUIRE(!work.result.failure);
  }

  std::vector<Waypoint> verify() {
    verify_window(job, false, work);
    REQUIRE(!work.result.failure);
    return work.result.waypoints;
  }

  // Ends of pieces that end a segment: how many there are, and of how many the very command was foreseen.
  struct Count {
    std::size_t ends = 0, foreseen = 0;
  };
  Count count() const {
    Count result;
    CorrectedMoves found(work.result.corrected);
    OtherLines lines;
    for (const Piece& piece : match_window(job, work.track, work.ways, lines, found).pieces) {
      if (piece.segment == no_segment || piece.u1 != 1) continue;
      const KnownTip& tip = work.known[piece.segment].end.after;
      ++result.ends;
      result.foreseen += tip.known && tip.command == point_at(piece.commanded, 1);
    }
    return result;
  }

  static Order in_lanes(Order order) {
    order.in_lanes = true;
    return order;
  }

  Shop shop;
  Job job;
  WindowWork work;
};

std::string zigzag(const std::string& head, int blocks, const std::string& format, double step = 0.5) {
  std::string text = head;
  for (int k = 0; k < blocks; ++k)
    text += fmt::format(fmt::runtime(format), step * (k + 1), k % 2 ? 3.25 : 2.75, 0.125 * (k % 5)) + "\n";
  return text + "M30\n";
}

Order order_of(const std::string& text) {
  return {.machine = load_machine(orthoglide_b), .text = text, .force = constant_force(milling())};
}

const std::string absolute = zigzag("G21 G90\nG0 X0. Y0. Z0.\nF1200\n", 40, "G1 X{:.3f} Y{:.3f} Z{:.3f}");

void check_same_results(const std::vector<Waypoint>& a, const std::vector<Waypoint>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CAPTURE(a[i].line);
    CAPTURE(a[i].fraction);
    CHECK(a[i].line == b[i].line);
    CHECK((a[i].before - b[i].before).cwiseAbs().maxCoeff() <= 1e-11);
    CHECK((a[i].after - b[i].after).cwiseAbs().maxCoeff() <= 1e-11);
    CHECK(a[i].correction == b[i].correction);
  }
}

std::vector<Waypoint> ends_of(std::vector<Waypoint> waypoints) {
  std::erase_if(waypoints, [](const Waypoint& w) { return w.between; });
  return waypoints;
}

// What nobody can take for an answer without its being seen.
void falsify(KnownTip& tip) {
  tip.X_MT.p += Vector3(0.5e-6, 0, 0);
}

}  // namespace

TEST_CASE("the command at the end of every absolute line is foreseen to the last bit") {
  const Order plain = order_of(absolute);
  Order inches = order_of(zigzag("G20 G90\nG0 X0. Y0. Z0.\nF40\n", 40, "G1 X{0:.4f} Y0.1 Z{2:.4f}", 0.02));
  Order turned = plain, shifted = plain, digits = plain, stepping = plain;
  turned.X_MW = {exp_so3({0.1, -0.2, 0.3}), {0.01, 0.02, -0.03}};
  shifted.datum_shift = Vector3(1e-4, -2e-4, 5e-5);
  digits.decimals = 5;
  stepping.force.blend = 0;
  for (const Order& order : {plain, inches, turned, shifted, digits, stepping}) {
    const WrittenRun run(order);
    const auto [ends, foreseen] = run.count();
    CHECK(ends >= 40);
    CHECK(foreseen == ends);
  }
}

TEST_CASE("words that are left away, arcs and ways are foreseen where their start is") {
  const std::string head = "G21 G90\nG0 X0. Y0. Z0.\nF1200\n";
  for (const std::string& text : {zigzag(head, 40, "G1 X{:.3f}"), zigzag(head, 40, "X{0:.3f}\nG1 Y{1:.3f}"),
                                  head + "G2 X10. Y10. I10. J0.\nG3 X0. Y0. I0. J-10.\nG1 X5.\nM30\n"}) {
    CAPTURE(text);
    const WrittenRun run(order_of(text));
    const auto [ends, foreseen] = run.count();
    CHECK(10 * foreseen >= 9 * ends);
  }
}

TEST_CASE("verification says the same whether what planning has found is known to it or not") {
  for (const std::string& text :
       {absolute, std::string("G21 G90\nG0 X0. Y0. Z0.\nG91\nG1 X1. F600\nY1.\nM30\n")}) {
    WrittenRun knows(order_of(text)), does_not(order_of(text));
    does_not.work.known.clear();
    check_same_results(knows.verify(), does_not.verify());
  }
}

TEST_CASE("what was foreseen as another command, or under another force, is solved anew") {
  WrittenRun right(order_of(absolute)), other_command(order_of(absolute)), other_force(order_of(absolute));
  for (KnownSegment& segment : other_command.work.known) {
    for (KnownTip* tip : {&segment.end.before, &segment.end.after}) {
      falsify(*tip);
      tip->command.y() = std::nextafter(tip->command.y(), 1.0);
    }
    if (segment.inside) segment.inside->after.command.y() += 1e-8;
  }
  for (KnownSegment& segment : other_force.work.known) {
    for (KnownTip* tip : {&segment.end.before, &segment.end.after}) falsify(*tip);
    segment.end.load.F[3] = std::nextafter(segment.end.load.F[3], 2.0);
    segment.inside.reset();
  }
  const std::vector<Waypoint> waypoints = right.verify();
  check_same_results(waypoints, other_command.verify());
  check_same_results(waypoints, other_force.verify());
}

TEST_CASE("what was foreseen is not solved again, before and after") {
  WrittenRun right(order_of(absolute)), falsified(order_of(absolute));
  for (KnownSegment& segment : falsified.work.known)
    for (KnownTip* tip : {&segment.end.before, &segment.end.after}) falsify(*tip);
  const std::vector<Waypoint> a = ends_of(right.verify()), b = ends_of(falsified.verify());
  REQUIRE(a.size() == b.size());
  CHECK(a.size() >= 40);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].segment == no_segment || a[i].fraction != 1) continue;
    CAPTURE(a[i].line);
    CHECK(std::abs(b[i].before[0] - a[i].before[0]) > 1e-7);
    CHECK(std::abs(b[i].after[0] - a[i].after[0]) > 1e-7);
  }
}

TEST_CASE(
    "a waypoint that is solved alone begins beside itself, whether what lies before it is known or not") {
  Order order = order_of(absolute);
  // Two lines far from each other have a load that lanes leave to others.
  std::string rows = "# frame = machine\n# sense = on_tool\nline, fx_N, fy_N, fz_N\n";
  for (int line = 4; line < 44; ++line)
    rows += fmt::format("{}, {}, -5, 0\n", line, line == 12 || line == 35 ? 1500 : 20);
  order.force.rules = read_force_csv(rows, "forces.csv");
  order.force.blend = 0;
  WrittenRun knows(order), does_not(order);
  const std::vector<KnownSegment> known = knows.work.known;
  does_not.work.known.clear();
  const std::vector<Waypoint> a = knows.verify(), b = does_not.verify();
  REQUIRE(a.size() == b.size());
  std::size_t alone = 0, between = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].segment == no_segment || a[i].between) continue;
    if (known[a[i].segment].end.after.known) {
      between += alone > 0;
      continue;
    }
    CAPTURE(a[i].line);
    CHECK(a[i].iterations == b[i].iterations);
    CHECK(a[i].before == b[i].before);
    CHECK(a[i].after == b[i].after);
    ++alone;
  }
  CHECK(alone == 2);
  CHECK(between >= 20);
}

TEST_CASE("lines that are looked into when they are planned are not looked into again") {
  WrittenRun run(order_of(absolute));
  std::size_t looks = 0, found = 0;
  for (const KnownSegment& segment : run.work.known) looks += segment.inside.has_value();
  std::vector<KnownSegment> known = run.work.known;
  for (const Waypoint& w : run.verify()) {
    if (!w.between || !known[w.segment].inside) continue;
    const KnownTip& tip = known[w.segment].inside->after;
    const Vector3 command = w.p_MT + w.correction.head<3>();
    found += tip.known && (tip.command - command).norm() <= 1e-15;
  }
  // Where tolerance and what rounding leaves of it judge otherwise another line is looked into.
  CHECK(looks >= 5);
  CHECK(found + 1 >= looks);
}

TEST_CASE("what planning finds does not depend on the number of threads") {
  Order order = order_of(zigzag("G21 G90\nG0 X0. Y0. Z0.\nF1200\n", 700, "G1 X{:.3f} Y{:.3f} Z{:.3f}", 0.1));
  const WrittenRun one(order);
  order.threads = 3;
  const WrittenRun three(order);
  CHECK(one.count().foreseen > 650);
  REQUIRE(one.work.known.size() == three.work.known.size());
  const auto same = [](const KnownTip& a, const KnownTip& b) {
    if (!a.known) return !b.known;
    return b.known && a.command == b.command && a.X_MT.p == b.X_MT.p && a.X_MT.R == b.X_MT.R &&
           a.iterations == b.iterations;
  };
  const auto same_place = [&](const KnownPlace& a, const KnownPlace& b) {
    return same(a.before, b.before) && same(a.after, b.after) && a.load.F == b.load.F;
  };
  for (std::size_t s = 0; s < one.work.known.size(); ++s) {
    CAPTURE(s);
    const KnownSegment &a = one.work.known[s], &b = three.work.known[s];
    CHECK(same_place(a.end, b.end));
    REQUIRE(a.inside.has_value() == b.inside.has_value());
    if (a.inside) CHECK(same_place(*a.inside, *b.inside));
  }
}

TEST_CASE("without lanes, and where targets are not solved in them, no place is known") {
  const Shop without(order_of(absolute));
  Order nested = order_of(absolute);
  nested.method = Method::nested;
  nested.in_lanes = true;
  const Shop other_method(nested);
  for (const Shop* shop : {&without, &other_method}) {
    const Job job = shop->job();
    CarriedState carried{Rewriter(job.options.write), TextReader(job.program, job.read)};
    WindowWork work;
    begin_window(job, carried, work);
    plan_window(job, work);
    CHECK(!work.failed());
    CHECK(work.plan.known.empty());
  }
}
