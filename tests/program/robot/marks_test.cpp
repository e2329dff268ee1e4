// Comments of posts that state with which lengths targets were computed.
#include <doctest/doctest.h>

#include <algorithm>

#include "program/reading.hpp"

using namespace counterflex;

TEST_CASE("a comment of nominal or accurate kinematics is reported with its line, once") {
  struct Job {
    std::string dialect, head, mark, tail;
  };
  const Job jobs[] = {
      {"kuka", "DEF job( )\n", "; ", "PTP {X 1,Y 2,Z 3,A 0,B 0,C 0}\nEND\n"},
      {"abb", "MODULE job\n", "! ", "PROC main()\nENDPROC\nENDMODULE\n"},
      {"ur", "def job():\n", "  # ", "  movel(p[1,0,0,0,0,0])\nend\n"},
      {"fanuc_tp", "/PROG JOB\n/MN\n", "   1:  !", "/POS\n/END\n"},
      {"apt", "PARTNO JOB\nUNITS/MM\n", "$$ ", "GOTO/1,2,3,0,0,1\nFINI\n"},
      {"yaskawa",
       "/JOB\n//NAME JOB\n//POS\n///NPOS 0,0,0,0,0,0\n//INST\n///DATE 2024/01/01 12:00\n///ATTR SC,RW\nNOP\n",
       "'", "END\n"}};
  for (const Job& job : jobs) {
    CAPTURE(job.dialect);
    const auto remarks = [&](const std::string& text) {
      return read_program(job.head + job.mark + text + "\n" + job.mark + text + "\n" + job.tail, "job",
                          {.dialect = job.dialect})
          .remarks;
    };
    const auto found = remarks("Using Nominal Kinematics.");
    REQUIRE(found.size() == 1);
    CHECK(found[0].line == std::count(job.head.begin(), job.head.end(), '\n') + 1);
    CHECK(found[0].what.starts_with("a comment states 'Nominal Kinematics': the errors of assembly"));
    CHECK(remarks("robot with absolute accuracy").size() == 1);
    CHECK(remarks("kinematics").empty());
  }
}
