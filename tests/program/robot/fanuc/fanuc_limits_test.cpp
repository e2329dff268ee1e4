// Programs of FANUC robots: what is refused, with line and column.
#include <doctest/doctest.h>

#include "program/robot/corpus.hpp"
#include "program/robot/fanuc/fanuc.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("motions that do not go to the programmed target are refused with their line") {
  for (const char* words : {"Tool_Offset,PR[15]", "Offset,PR[1]", "Offset", "INC", "Skip,LBL[1]", "COORD",
                            "COORD PTH", "RTCP", "VOFFSET,VR[1]"}) {
    const std::string word = words;
    CAPTURE(word);
    const std::string shown = word.substr(0, word.find(' '));
    CHECK(
        tp_refusal("L P[1] 9mm/sec FINE ;\nL P[2] 9mm/sec CNT60 " + word + " ;\n") ==
        "job.ls:7:27: error: '" + shown +
            "' moves the tool to another place than the programmed target, which is not supported; post the "
            "job without it");
  }
  CHECK(tp_refusal("J P[1] 100% CNT60 Tool_Offset,PR[15] \t;\n")
            .starts_with("job.ls:6:24: error: 'Tool_Offset,PR[15]'"));
}

TEST_CASE("statements that displace the targets are refused with their line") {
  for (const char* statement :
       {"OFFSET CONDITION PR[1]", "TOOL_OFFSET CONDITION PR[1]", "Weave Sine[5]", "Track TAST[1]",
        "Search Start[1] PR[2]", "Touch Offset PR[3]", "LINE[1] ON", "SETTRIG LNSCH[1]"}) {
    CAPTURE(statement);
    CHECK(tp_refusal("  " + std::string(statement) + " ;\nL P[1] 9mm/sec FINE ;\n")
              .starts_with("job.ls:6:8: error: '" + std::string(statement) + "' moves the tool away"));
  }
}

TEST_CASE("targets that are not positions with numbers are refused with their line") {
  CHECK(
      tp_refusal("L PR[1] 9mm/sec FINE ;\n") ==
      "job.ls:6:8: error: the target PR[1] is a position register, whose value is not in the program; use a "
      "position of /POS, P[1]");
  CHECK(tp_refusal("L P[R[1]] 9mm/sec FINE ;\n") ==
        "job.ls:6:8: error: the target P[R[1]] is selected at run time; write its number");
  CHECK(tp_refusal("L P[7] 9mm/sec FINE ;\n") ==
        "job.ls:6:8: error: the target P[7] is not in /POS; add it there");
  CHECK(tp_refusal("A P[1] 9mm/sec FINE ;\n") ==
        "job.ls:6:6: error: the motion type A is not supported; post the job with J, L and C");
  CHECK(tp_refusal("P[1]=PR[2] ;\n")
            .starts_with("job.ls:6:6: error: a position of /POS is computed at run time"));
  CHECK(tp_refusal("L P[1] 9mm/sec FINE\n") == "job.ls:6:6: error: the motion has no ';' at its end");
  const Program registers = read_tp_statements("J PR[1:HOME] 10% FINE ;\nL P[1] 9mm/sec FINE ;\n");
  CHECK(registers.left_alone[0].machine_position);
  CHECK(!registers.moves[0].known_start[0]);
}

TEST_CASE("a target of another frame or tool than the selected one is refused with its line") {
  CHECK(tp_refusal("UFRAME_NUM=3 ;\nL P[1] 9mm/sec FINE ;\n") ==
        "job.ls:7:8: error: the target P[1] has UF : 1, but UFRAME_NUM=3 is selected: the control stops "
        "here; select "
        "UFRAME_NUM=1 before the motion");
  CHECK(tp_refusal("UTOOL_NUM=1 ;\nL P[1] 9mm/sec FINE ;\n")
            .starts_with("job.ls:7:8: error: the target P[1] has UT : 2"));
  for (const char* statement : {"UFRAME_NUM=R[1] ;\n", "UFRAME_NUM=3 ;\nLBL[1] ;\n",
                                "UFRAME_NUM=3 ;\nCALL A ;\n", "UFRAME_NUM=3 ;\nIF R[1]=2,UFRAME_NUM=1 ;\n"})
    CHECK(tp_refusal(statement + std::string("L P[1] 9mm/sec FINE ;\n")) == "none");
}

TEST_CASE("lists of positions that are wrong are refused with line and column") {
  const std::string line = "L P[1] 9mm/sec FINE ;\n";
  const auto refused = [&](const std::string& positions) { return tp_refusal(line, positions); };
  const std::string good = tp_position(1, {0, 0, 0, 0, 0, 0});
  CHECK(
      refused(good + good).starts_with("job.ls:14:1: error: the position P[1] is defined in line 8 already"));
  CHECK(refused(good.substr(0, good.find('}')))
            .starts_with("job.ls:8:1: error: the position P[1] has no '}' at its end"));
  CHECK(refused("Q[1]{};\n").starts_with("job.ls:8:1: error: this is not a position of /POS"));
  CHECK(refused("P[1]{\n GP1:\n UF : 1, UT : 2\n};\n")
            .starts_with("job.ls:8:1: error: the position needs X, Y, Z"));
  CHECK(refused("P[1]{\n   GP2:\n\tJ1= 0 deg\n};\n")
            .starts_with("job.ls:8:1: error: the position needs X, Y, Z"));
  std::string bad = good;
  CHECK(refused(bad.replace(bad.find("0.000  mm"), 5, "*****")).starts_with("job.ls:11:") == true);
  bad = good;
  CHECK(refused(bad.replace(bad.find("mm"), 2, "in")) ==
        "job.ls:11:10: error: 'X' of the position has the unit 'IN'; it must be mm");
  bad = good;
  CHECK(refused(bad.replace(bad.find("X ="), 3, "Q ="))
            .starts_with("job.ls:11:10: error: 'Q' of the position is not known"));
  CHECK(tp_refusal("L P[1] 9mm/sec FINE ;\nno number\n") == "none");
  std::string text = tp_program(line, good);
  text.replace(text.find("   1:"), 5, "     ");
  CHECK(diagnostic_of([&] {
          read_tp(text);
        }).starts_with("job.ls:6:6: error: 'L P[1] 9mm/sec FINE ;' is not a line of /MN"));
}

TEST_CASE("each FANUC program of a folder of real programs is reproduced or refused with its line") {
  const auto is_wanted = [](const std::filesystem::path& path) {
    return path.extension() == ".ls" || path.extension() == ".LS";
  };
  check_corpus(is_wanted, text_of_file);
}
