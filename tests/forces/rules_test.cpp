#include <doctest/doctest.h>
#include <fmt/format.h>

#include <map>
#include <random>

#include "forces/sample_cut.hpp"
#include "forces/sample_path.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

const std::string columns = "fx_N,fy_N,fz_N\n";

/// The source of several CSV texts (with the settings of `on_tool`) and --force texts, in their order.
ForceSource given(const std::vector<std::string>& texts) {
  ForceSource source;
  source.blend = 0;
  int files = 0;
  for (const std::string& text : texts) {
    if (text.find('\n') == std::string::npos) {
      source.rules.push_back(parse_force_rule(text));
      continue;
    }
    const auto rules = read_force_csv(on_tool + text, fmt::format("{}.csv", "abc"[files++]));
    source.rules.insert(source.rules.end(), rules.begin(), rules.end());
  }
  return source;
}

/// fx in the middle of the cuts of the sample program: lines 2, 3, 5 and 6.
std::vector<double> middle_fx(const PathForces& forces) {
  std::vector<double> fx;
  for (const std::size_t i : {1, 2, 4, 5}) fx.push_back(forces.at(i, 0.5)[0]);
  return fx;
}

std::vector<double> middle_fx(const std::vector<std::string>& texts) {
  return middle_fx(forces_on(sample_program(), given(texts)));
}

std::string refused(const Program& program, const ForceSource& source) {
  try {
    forces_on(program, source);
  } catch (const InputError& error) {
    const bool of_option = error.kind() == ErrorKind::usage,
               of_file = error.kind() == ErrorKind::machine_or_force;
    return fmt::format("{}: {}", of_option ? "option" : of_file ? "file" : "other kind", error.what());
  }
  return "no error";
}

/// The rule of a section.
ForceRule section_for(const ForceSelector& selector) {
  return {"section 1", {"cut.toml", 9, 1}, selector, respond(sample_cut())};
}

}  // namespace

TEST_CASE("the most specific rule acts: a place before an operation, a tool, and all") {
  const std::string all = "1,0,0", tool = "tool," + columns + "T3,2,0,0\n",
                    op = "op," + columns + "finish*,3,0,0\n", place = "line," + columns + "5,4,0,0\n6,,,\n";
  using Values = std::vector<double>;
  CHECK(middle_fx({all}) == Values{1, 1, 1, 1});
  CHECK(middle_fx({all, tool}) == Values{1, 1, 2, 2});
  CHECK(middle_fx({op, all, tool}) == Values{1, 1, 3, 3});
  CHECK(middle_fx({tool, place, all}) == Values{1, 1, 4, 2});
  CHECK(middle_fx({place, op, tool, all}) == Values{1, 1, 4, 3});
}

TEST_CASE("--force of a tool acts where that tool is in the spindle") {
  CHECK(middle_fx({"T1=7,0,0", "t3=-8,0,0,1,2,3"}) == std::vector<double>{7, 7, -8, -8});
}

TEST_CASE("the text of an operation is compared without case and outer blanks, to its end or to a star") {
  for (const char* name : {"ROUGH POCKET", "rough pocket", "  Rough Pocket ", "rough*", "Rough pocket*"}) {
    CAPTURE(name);
    const auto fx = middle_fx({"op," + columns + name + ",5,0,0\n", "1,0,0"});
    CHECK(fx == std::vector<double>{5, 5, 1, 1});
  }
  for (const char* name : {"ROUGH", "pocket", "Rough pocket 2"}) {
    CAPTURE(name);
    CHECK(refused(sample_program(), given({"op," + columns + name + ",5,0,0\n", "1,0,0"}))
              .find("unknown operation") != std::string::npos);
  }
}

TEST_CASE("an operation's name with commas is in quotes") {
  Program program = sample_program();
  program.operations[2] = "FINISH, wall 2";
  const auto source = given({"op , " + columns + " \"Finish, Wall 2\" ,5,0,0\n\"rough*\",\"3\",0,0\n"});
  CHECK(middle_fx(forces_on(program, source)) == std::vector<double>{3, 3, 5, 5});
  CHECK_THROWS_WITH_AS(given({"op," + columns + "\"Finish, wall 2,5,0,0\n"}),
                       "a.csv:4:19: error: row 1 has 5 fields, the header has 4", InputError);
}

TEST_CASE("a FORCE comment is a rule for its place, and where none acts other rules do") {
  Program program = sample_program();
  program.moves[2].force = wrench(9, 0, 0);
  program.moves[4].force = wrench(0, 0, 0);
  CHECK(middle_fx(forces_on(program, given({"1,0,0"}))) == std::vector<double>{1, 9, 0, 1});
  CHECK(middle_fx(forces_on(program, given({"tool," + columns + "1,2,0,0\n3,3,0,0\n"}))) ==
        std::vector<double>{2, 9, 0, 3});
  const auto lines = given({"line," + columns + "2,4,0,0\n3,,,\n6,6,0,0\n"});
  CHECK(middle_fx(forces_on(program, lines)) == std::vector<double>{4, 9, 0, 6});
  CHECK(refused(program, given({"line," + columns + "2,4,0,0\n"})) ==
        "file: a.csv:4:1: error: covers line 3 of the program, which a FORCE comment covers too; both are "
        "given "
        "for places: one of them must not cover it");
}

TEST_CASE("a step profile covers from its first row to the program's end, a linear one to its last row") {
  const std::string rest = "1,0,0";
  CHECK(middle_fx({"line," + columns + "3,4,0,0\n", rest}) == std::vector<double>{1, 4, 4, 4});
  ForceSource source = given({rest});
  source.rules.push_back(read_force_csv(linear + "s_mm," + columns + "10,10,0,0\n25,40,0,0\n", "l.csv")[0]);
  const auto forces = forces_on(sample_program(), source);
  CHECK(near(forces.at(1, 0.5), wrench(1, 0, 0)));
  CHECK(near(forces.at(2, 0.5), wrench(20, 0, 0)));
  CHECK(near(forces.at(4, 0.6), wrench(1, 0, 0)));
  CHECK(near(forces.at(4, 0.4), wrench(38, 0, 0)));
  REQUIRE(forces.breaks(4).size() == 1);
  CHECK(forces.breaks(4)[0] == doctest::Approx(0.5));
}

TEST_CASE("a row without numbers ends the cover until the next row, inside a move, too") {
  const auto forces = forces_on(
      sample_program(), given({"s_mm," + columns + "0,4,0,0\n13,,,\n18,6,0,0\n30,,,\n40,9,0,0\n", "1,0,0"}));
  for (const auto& [fraction, fx] : {std::pair{0.2, 4}, {0.5, 1}, {0.9, 6}}) {
    const auto& shown = fraction;
    CAPTURE(shown);
    CHECK(forces.at(2, fraction) == wrench(fx, 0, 0));
  }
  CHECK(forces.at(4, 0.5) == wrench(6, 0, 0));
  CHECK(forces.at(5, 0.5) == wrench(1, 0, 0));
  CHECK(forces.breaks(2).size() == 2);
}

TEST_CASE("in a linear profile the wrench holds before a row that ends the cover") {
  ForceSource source = given({"1,0,0"});
  const std::string rows = "0,0,0,0\n4,40,0,0\n8,,,\n12,7,0,0\n40,7,0,0\n";
  source.rules.push_back(read_force_csv(linear + "s_mm," + columns + rows, "l.csv")[0]);
  const auto forces = forces_on(sample_program(), source);
  CHECK(near(forces.at(1, 0.2), wrench(20, 0, 0)));
  CHECK(near(forces.at(1, 0.6), wrench(40, 0, 0)));
  CHECK(near(forces.at(1, 0.9), wrench(1, 0, 0)));
  CHECK(near(forces.at(2, 0.5), wrench(7, 0, 0)));
}

TEST_CASE("profiles that touch, to within the rounding of their keys, do not overlap") {
  for (const char* second : {"20,2,0,0\n", "19.9995,2,0,0\n", "20.0005,2,0,0\n"}) {
    CAPTURE(second);
    ForceSource source;
    source.blend = 0;
    for (const std::string& rows : {std::string("0,1,0,0\n20,1,0,0\n"), second + std::string("40,2,0,0\n")})
      source.rules.push_back(
          read_force_csv(linear + "s_mm," + columns + rows, std::string(1, second[0]) + ".csv")[0]);
    CHECK(middle_fx(forces_on(sample_program(), source)) == std::vector<double>{1, 1, 2, 2});
  }
}

TEST_CASE("a profile whose cover ends within the rounding of its keys leaves a move to its FORCE comment") {
  for (const char* rows : {"0,1,0,0\n10.0005,,,\n20,2,0,0\n", "0,1,0,0\n10,,,\n19.9995,2,0,0\n"}) {
    CAPTURE(rows);
    Program program = sample_program();
    program.moves[2].force = wrench(9, 0, 0);
    const auto forces = forces_on(program, given({"s_mm," + columns + rows}));
    CHECK(middle_fx(forces) == std::vector<double>{1, 9, 2, 2});
    CHECK(forces.at(2, 0.01) == wrench(9, 0, 0));
    CHECK(forces.at(2, 0.99) == wrench(9, 0, 0));
  }
}

TEST_CASE("rules of equal rank that cover one move are refused, for all kinds of rules") {
  const std::string t3 = "tool," + columns + "T3,2,0,0\n";
  CHECK(
      refused(sample_program(), given({"1,0,0", "2,0,0"})) ==
      "option: error: --force 1,0,0: covers line 2 of the program, which --force 2,0,0 covers too; both are "
      "given for the whole program: one of them must be more specific");
  CHECK(refused(sample_program(), given({t3, "1,0,0", "T3=4,0,0"})) ==
        "file: a.csv:4:1: error: covers line 5 of the program, which --force T3=4,0,0 covers too; both are "
        "given for tools: one of them must be more specific");
  ForceSource source = given({"1,0,0"});
  source.rules.push_back(section_for({.lines = {{2, 3}}}));
  source.rules.push_back(section_for({.blocks = {{20, 50}}}));
  source.rules[2].where.line = 20;
  CHECK(refused(sample_program(), source) ==
        "file: cut.toml:20:1: error: section 1: covers line 2 of the program, which section 1 (cut.toml:9) "
        "covers too; both are given for places: narrow lines or blocks of one of them");
  source.rules.pop_back();
  source.rules.push_back(read_force_csv(on_tool + "line," + columns + "3,4,0,0\n", "l.csv")[0]);
  CHECK(refused(sample_program(), source) ==
        "file: l.csv:4:1: error: covers line 3 of the program, which section 1 (cut.toml:9) covers too; both "
        "are "
        "given for places: narrow lines or blocks of the section, or end the rows with one that has its key "
        "only");
}

TEST_CASE("a tool that the program never uses is refused at the row or the option that names it") {
  CHECK(refused(sample_program(), given({"0,0,0", "T9=1,0,0"})) ==
        "option: error: --force T9=1,0,0: unknown tool T9: the program uses T1, T3");
  CHECK(refused(straight(10, 5), given({"0,0,0", "T9=1,0,0"})) ==
        "option: error: --force T9=1,0,0: unknown tool T9: the program uses no tool with a number");
}

TEST_CASE("a rule that covers no feed move is refused at its place, unless its force is zero") {
  Program program = sample_program();
  program.moves[0].tool = 7;  // a rapid
  const std::string rows = "tool," + columns + "T3,2,0,0\nT7,";
  CHECK(refused(program, given({"1,0,0", rows + "2,0,0\n"})) ==
        "file: a.csv:5:1: error: tool T7 covers no feed move of the program");
  CHECK(refused(program, given({"1,0,0", "T7=2,0,0"})) ==
        "option: error: --force T7=2,0,0: tool T7 covers no feed move of the program");
  CHECK(refused(program, given({"1,0,0", rows + "0,0,0\n"})) == "no error");
  for (const ForceSelector& selector :
       {ForceSelector{.tool = 3, .operation = "rough*"}, ForceSelector{.blocks = {{11, 19}}},
        ForceSelector{.lines = {{4, 4}}}, ForceSelector{.tool = 1, .lines = {{5, 6}}}}) {
    ForceSource source = given({"1,0,0"});
    source.rules.push_back(section_for(selector));
    const std::string said = refused(sample_program(), source);
    CAPTURE(said);
    CHECK(said.find("cut.toml:9:1: error: section 1: ") != std::string::npos);
    CHECK(said.ends_with("covers no feed move of the program"));
  }
}

TEST_CASE("a move in the air or under a FORCE comment is covered; a program without feed moves has none") {
  ForceSource source = given({"1,0,0", "T3=2,0,0"});
  source.air_above_mm = 4.9;
  CHECK(refused(sample_program(), source) == "no error");
  Program program = sample_program();
  program.moves[4].force = program.moves[5].force = wrench(1, 0, 0);
  CHECK(refused(program, given({"1,0,0", "T3=2,0,0"})) == "no error");
  program.moves[1].motion = program.moves[2].motion = program.moves[4].motion = program.moves[5].motion =
      Motion::rapid;
  CHECK(refused(program, given({"1,0,0", "T3=2,0,0"})) == "no error");
}

TEST_CASE("whether a rule covers a feed move is found in windows of a program as in the whole") {
  const Program whole = sample_program();
  using Case = std::pair<std::array<long, 2>, std::string>;
  for (const auto& [blocks, said] : {Case{{50, 60}, ""}, Case{{31, 39}, "covers no feed move"}}) {
    ForceSource source = given({"1,0,0"});
    source.rules.push_back(section_for({.blocks = blocks}));
    ForceCover cover(source);
    PathEnd end;
    for (const Move& move : whole.moves) {
      Program window = whole;
      window.moves.assign(1, move);
      const Toolpath path = build_toolpath(window, one_frame(window, {}), end);
      cover.add(window, path);
      end = path.end;
    }
    std::string refusal;
    try {
      cover.end_pass();
    } catch (const InputError& error) {
      refusal = error.what();
    }
    CAPTURE(refusal);
    CHECK(refusal.empty() == said.empty());
    CHECK(refusal.find(said) != std::string::npos);
  }
}

TEST_CASE("sections of a cutting model cover moves that meet all of their conditions") {
  Program program = sample_program();
  for (Move& move : program.moves) move.spindle_rpm = 3000;
  const Vector6 cut = cutting_force(sample_cut(), 0.01, 3000, 0).F;
  struct Case {
    ForceSelector selector;
    std::vector<std::size_t> cut;  ///< segments
  };
  for (const Case& c : {Case{{}, {2, 4, 5}}, Case{{.tool = 3}, {4, 5}}, Case{{.operation = "ROUGH*"}, {2}},
                        Case{{.lines = {{3, 5}}}, {2, 4}}, Case{{.blocks = {{20, 30}}}, {2}},
                        Case{{.tool = 3, .lines = {{3, 5}}}, {4}},
                        Case{{.operation = "finish wall", .blocks = {{40, 40}}}, {4}},
                        Case{{.tool = 3, .operation = "finish wall"}, {4, 5}},
                        Case{{.tool = 1, .operation = "rough*", .lines = {{1, 2}}}, {}}}) {
    ForceSource source = given({"0,0,0,0,0,1"});
    if (c.selector.tool || c.selector.operation || c.selector.lines || c.selector.blocks)
      source.rules.push_back(section_for(c.selector));
    else
      source.rules = {section_for({})};
    const auto forces = forces_on(program, source);
    for (const std::size_t i : {2, 4, 5}) {
      CAPTURE(i);
      const bool is_cut = std::find(c.cut.begin(), c.cut.end(), i) != c.cut.end();
      const double size = forces.at(i, 0.5).head<3>().norm();
      CHECK(size == doctest::Approx(is_cut ? cut.head<3>().norm() : 0));
    }
  }
}

TEST_CASE("a rule for lines of an operation acts in them whenever that operation comes back") {
  Program program = straight(12, 1);
  program.operations = {"", " Wall a", "floor"};
  for (std::size_t i = 0; i < 12; ++i) program.moves[i].operation = static_cast<std::uint32_t>(i % 3);
  ForceSource source = given({"1,0,0"});
  for (const auto& [operation, fx] : {std::pair{"wall*", 2}, {"FLOOR ", 3}})
    source.rules.push_back({"rule",
                            {"r.csv", fx, 1},
                            {.operation = operation, .lines = {{1, 9}}},
                            ConstantForce{wrench(fx, 0, 0)}});
  const auto forces = forces_on(program, source);
  for (std::size_t i = 0; i < 12; ++i)
    CHECK(forces.at(i, 0.5)[0] == (i < 9 ? 1 + static_cast<int>(i % 3) : 1));
}

TEST_CASE("a section for lines or blocks beyond the program's end is refused") {
  ForceSource source = given({"0,0,0"});
  source.rules.push_back(section_for({.lines = {{7, 9}}}));
  CHECK(refused(sample_program(), source) ==
        "file: cut.toml:9:1: error: section 1: lines 7 to 9 are beyond the end of the program at line 6");
  source.rules.back() = section_for({.blocks = {{60, 90}}});
  CHECK(
      refused(sample_program(), source) ==
      "file: cut.toml:9:1: error: section 1: blocks 60 to 90 are beyond the end of the program at block 50");
}

TEST_CASE("wrenches at the platform and at the tip are not mixed, not with a FORCE comment either") {
  const auto source = from_csv(on_tool + "# at = platform\nline," + columns + "1,1,0,0\n5,,,\n");
  Program program = sample_program();
  program.moves[4].force = program.moves[5].force = wrench(1, 0, 0);
  CHECK(refused(program, source) ==
        "file: forces.csv:5:1: error: acts at the platform, but the FORCE comment for line 5 acts at the "
        "tip; one "
        "run has its forces at one of the two places");
  program.moves[4].force = program.moves[5].force = wrench(0, 0, 0);
  CHECK(forces_on(program, source).at_platform());
}

TEST_CASE("a zero wrench is neither at the tip nor at the platform: it goes with both") {
  ForceSource source = from_csv(on_tool + "# at = platform\nline," + columns + "3,1,0,0\n");
  source.rules.push_back(parse_force_rule("0,0,0"));
  const auto forces = forces_on(sample_program(), source);
  CHECK(forces.at_platform());
  CHECK(middle_fx(forces) == std::vector<double>{0, 1, 1, 1});
}

TEST_CASE("a profile or a model that is zero everywhere is neither at the tip nor at the platform") {
  const std::string zeros = "line," + columns + "3,0,0,0\n4,,,\n5,-0,0,0\n";
  ForceSource source = from_csv(on_tool + "# at = platform\n" + zeros);
  CHECK_FALSE(acts_at_platform(source));
  source.rules.push_back(parse_force_rule("10,0,0"));
  const auto forces = forces_on(sample_program(), source);
  CHECK_FALSE(forces.at_platform());
  CHECK(middle_fx(forces) == std::vector<double>{10, 0, 0, 0});
  Program program = sample_program();
  program.moves[1].force = wrench(1, 0, 0);
  CHECK(middle_fx(forces_on(program, source)) == std::vector<double>{1, 0, 0, 0});
  // as soon as one component of one row acts, the two meet
  source.rules[0] = read_force_csv(on_tool +
                                       "# at = platform\nline,fx_N,fy_N,fz_N,mz_Nm\n3,0,0,0,0\n"
                                       "5,0,0,0,1\n",
                                   "forces.csv")[0];
  CHECK(refused(sample_program(), source) ==
        "file: forces.csv:5:1: error: acts at the platform, but --force 10,0,0 acts at the tip; one run has "
        "its "
        "forces at one of the two places");
  ForceRule air = section_for({.lines = {{2, 2}}});
  air.content = CutResponse{.flutes = 3, .spindle_rpm = 1000};
  CHECK(is_zero(air));
  source = from_csv(on_tool + "# at = platform\nline," + columns + "3,1,0,0\n");
  source.rules.push_back(air);
  CHECK(middle_fx(forces_on(sample_program(), source)) == std::vector<double>{0, 1, 1, 1});
  CHECK_FALSE(is_zero(section_for({})));
}

TEST_CASE("the tool's axes are needed as soon as one rule's frame turns with them") {
  const auto frame = [](const char* name) {
    return read_force_csv(fmt::format("# frame = {}\n# sense = on_tool\nline,{}1,1,0,0\n", name, columns),
                          "f.csv")[0];
  };
  ForceSource source = given({"1,0,0", "T3=1,0,0"});
  source.rules.push_back(frame("work"));
  CHECK_FALSE(needs_tool_axes(source));
  for (const ForceRule& rule : {frame("tool"), frame("feed"), section_for({})}) {
    ForceSource more = source;
    more.rules.push_back(rule);
    CHECK(needs_tool_axes(more));
  }
}

TEST_CASE("the force at every place equals the result of a search through all rules") {
  std::mt19937 random(23);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (int run = 0; run < 30; ++run) {
    CAPTURE(run);
    Program program = straight(60, 3);
    program.operations = {"", "A", "B", "C"};
    for (Move& move : program.moves) {
      move.tool = 1 + below(3);
      move.operation = static_cast<std::uint32_t>(below(4));
    }
    program.moves[0].tool = 2;
    program.moves[1].operation = 3;
    std::map<double, std::optional<double>> rows;  // of two profiles, whose covers take turns
    std::array<std::string, 2> profiles{"s_mm," + columns, "s_mm," + columns};
    for (int s = 0, turn = 0; s < 58; s += 1 + below(5), turn = below(3)) {
      const double key = s + 0.37;
      for (int p = 0; p < 2; ++p)
        profiles[static_cast<std::size_t>(p)] +=
            p == turn ? fmt::format("{},{},0,0\n", key, 100 + s) : fmt::format("{},,,\n", key);
      rows[key] = turn < 2 ? std::optional<double>(100 + s) : std::nullopt;
    }
    const auto forces = forces_on(program, given({profiles[0], "tool," + columns + "T2,2,0,0\n", "1,0,0",
                                                  "op," + columns + "c,3,0,0\n", profiles[1]}));
    for (std::size_t i = 0; i < program.moves.size(); ++i)
      for (const double u : {0.05, 0.2, 0.4, 0.6, 0.8, 0.97}) {
        const double s = 3 * (static_cast<double>(i) + u);
        const auto next = rows.upper_bound(s);
        const auto row = next == rows.begin() ? std::nullopt : std::prev(next)->second;
        const Move& move = program.moves[i];
        const double expected = row ? *row : move.operation == 3 ? 3 : move.tool == 2 ? 2 : 1;
        CHECK(forces.at(i, u)[0] == expected);
      }
  }
}

TEST_CASE("thousands of rules are found fast and completely") {
  const std::size_t count = 3000;
  Program program = straight(static_cast<double>(count), 1);
  std::string rows = "tool," + columns;
  ForceSource source;
  source.blend = 0;
  for (std::size_t i = 0; i < count; ++i) {
    program.operations.push_back(fmt::format("op {} end", i));
    program.moves[i].operation = static_cast<std::uint32_t>(i + 1);
    program.moves[i].tool = static_cast<int>(i) + 1;
    if (i % 3 == 0) rows += fmt::format("T{},{},0,0\n", i + 1, i);
    ForceSelector selector;
    if (i % 3 == 1) selector.operation = fmt::format("OP {} *", i);
    if (i % 3 == 2) selector.lines = {{static_cast<long>(i) + 1, static_cast<long>(i) + 1}};
    if (i % 3 != 0)
      source.rules.push_back(
          {"rule", {"r.csv", 1, 1}, selector, ConstantForce{wrench(static_cast<double>(i), 0, 0)}});
  }
  for (const ForceRule& rule : read_force_csv(on_tool + rows, "t.csv")) source.rules.push_back(rule);
  const auto forces = forces_on(program, source);
  for (std::size_t i = 0; i < count; ++i) CHECK(forces.at(i, 0.5)[0] == static_cast<double>(i));
}
