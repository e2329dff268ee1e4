// Programs of ABB robots: what is refused or not followed, and modules in windows.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "counterflex/files/files.hpp"
#include "program/outline.hpp"
#include "program/robot/corpus.hpp"
#include "program/robot/rapid/rapid.hpp"

using namespace counterflex;
using namespace counterflex::test;

TEST_CASE("what is computed at run time is not followed and is listed with its line") {
  const std::string declarations =
      "VAR robtarget p1:=" + target_at("1,2,3") + ";\nPERS robtarget p2:=" + target_at("1,2,3") +
      ";\nVAR robtarget p3:=" + target_at("1,2,3") + ";\nCONST robtarget p4:=" + target_at("1,2,3") +
      ";\nVAR robtarget list{2};\nVAR robtarget empty_one;\n"
      "VAR wobjdata w:=[FALSE,TRUE,\"\",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n"
      "VAR wobjdata turntable:=[FALSE,FALSE,\"STN1\",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n";
  const auto why = [&](const std::string& statement) {
    const Program program = read_rapid(module_of(
        declarations, "MoveJ " + target_at("0,0,0") + ",v100,fine,tool0;\n" + statement +
                          "p1.trans.z := 5;\nTeach p2, p4;\nIF p4=p3 SearchL di1, p3, p4, v100, tool0;\n"
                          "w.uframe.trans.x := 1;\n"));
    REQUIRE(program.moves.size() >= 2);
    CHECK(program.moves[1].fixed[0]);
    CHECK(program.left_alone[0].line == 12);
    return program.left_alone[0].why;
  };
  CHECK(why("MoveL p1,v100,z1,tool0;\n") == "the target 'p1' is computed at run time in line 13");
  CHECK(why("MoveL P2,v100,z1,tool0;\n") == "the target 'p2' is computed at run time in line 14");
  CHECK(why("MoveL p3,v100,z1,tool0;\n") == "the target 'p3' is computed at run time in line 15");
  CHECK(why("MoveL list{1},v100,z1,tool0;\n") == "the target is computed at run time");
  CHECK(why("MoveL empty_one,v100,z1,tool0;\n") == "the target 'empty_one' is declared without numbers");
  CHECK(why("MoveL elsewhere,v100,z1,tool0;\n") == "the target 'elsewhere' is not in this file");
  CHECK(why("MoveL CRobT(),v100,z1,tool0;\n") == "the target is computed at run time");
  CHECK(why("MoveL p4,v100,z1,tool0\\WObj:=w;\n") ==
        "the work object 'w' is computed at run time in line 16");
  CHECK(why("MoveL p4,v100,z1,tool0\\WObj:=turntable;\n") ==
        "a mechanical unit moves the work object 'turntable'");
  CHECK(why("MoveL p4,v100,z1,tools{i};\n") == "the tool is selected at run time");
  CHECK(why("MoveL p4,v100,z1,tool0\\Corr;\n") == "\\Corr adds corrections at run time");
  CHECK(why("TriggL p4,v100,t1,z1,tool0;\n") == "'TriggL' is not supported");
  const Program program =
      read_rapid(module_of(declarations, "SetDataVal \"p2\", 5;\nMoveL p3,v5,z1,tool0;\n"));
  CHECK(program.left_alone[1].why == "the target 'p3' is computed at run time in line 11");
}

TEST_CASE("an instruction or a function that writes its argument makes the value unknown") {
  const std::string declarations =
      "PERS robtarget p2:=" + target_at("1,2,3") + ";\nVAR robtarget p3:=" + target_at("1,2,3") +
      ";\nVAR wobjdata w:=[FALSE,TRUE,\"\",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n"
      "FUNC bool lower(INOUT robtarget p,num d)\np.trans.z:=p.trans.z-d;\nRETURN TRUE;\nENDFUNC\n"
      "FUNC num height(robtarget p)\nRETURN p.trans.z;\nENDFUNC\n"
      "PROC show(robtarget p)\nTPWrite \"z\"\\Num:=p.trans.z;\nENDPROC\n";
  const auto why = [&](const std::string& statement) {
    const Program program =
        read_rapid(module_of(declarations, "MoveL p2,v100,z1,tool0\\WObj:=w;\n" + statement));
    REQUIRE(program.moves.size() == 1);
    return program.moves[0].fixed[0] ? program.left_alone[0].why : "";
  };
  const std::string target = "the target 'p2' is computed at run time in line 17";
  for (const char* statement :
       {"Add p2.trans.z,-2;\n", "Incr p2.trans.x;\n", "Decr p2.trans.x;\n", "Clear p2.trans.x;\n",
        "ok:=StrToVal(line,p2.trans.z);\n", "ok:=lower(p2,2);\n", "IF lower(p2,2) THEN\nENDIF\n",
        "IF a AND lower(p2,2) SetDO do1,1;\n", "IF a IF b Incr p2.trans.x;\n",
        "WHILE NOT(a OR lower(p2,2)) DO\nENDWHILE\n", "SetGO go1,Round(2+elsewhere(p2));\n",
        "RETURN lower(p2,2);\n", "VAR bool ok:=lower(p2,2);\n", "WaitDI di1,1\\TimeFlag:=p2;\n",
        "GetDataVal \"p3\",p2;\n", "j:=CalcJointT(p3,tool0\\ErrorNumber:=p2);\n"}) {
    CAPTURE(statement);
    CHECK(why(statement) == target);
  }
  CHECK(why("Add w.oframe.trans.y,660;\n") == "the work object 'w' is computed at run time in line 17");
  for (const char* statement :
       {"Add n,p3.trans.z;\n", "p3:=Offs(p2,0,0,5);\n", "d:=Distance(p2.trans,p3.trans);\n",
        "n:=height(p2);\n", "show p2;\n",
        "IF (p2.trans.z>5 OR (p2.trans.x>1)) AND (p2.trans.y>1) THEN\nENDIF\n",
        "j:=CalcJointT(p2,tool0\\WObj:=w);\n", "MoveAbsJ CalcJointT(p2,tool0\\WObj:=w),v100,fine,tool0;\n",
        "MoveJDO p2,v100,fine,tool0\\WObj:=w,do1,1;\n", "TriggJ p2,v100,trig1,z1,tool0\\WObj:=w;\n",
        "TPWrite \"z\"\\Num:=p2.trans.z;\n", "WaitTime\\InPos,p2.trans.z;\n", "SetDO do1,1;\n"}) {
    CAPTURE(statement);
    CHECK(why(statement) == "");
  }
}

TEST_CASE("a routine of the module that does not move the robot keeps its position") {
  const std::string declarations =
      "VAR robtarget p1:=" + target_at("1,2,3") + ";\nVAR robtarget p2:=" + target_at("4,5,6") +
      ";\nPROC coolant()\nIF on THEN\nSetDO do1,1;\nELSE\nlubricate;\nENDIF\nWaitTime 0.5;\nENDPROC\n"
      "PROC lubricate()\nSet do2;\nENDPROC\nPROC lower()\np2.trans.z:=2;\nENDPROC\n"
      "PROC retract()\nIF on MoveJ p1,v100,fine,tool0;\nENDPROC\nPROC mode()\nConfL\\Off;\nENDPROC\n"
      "PROC away()\nlubricate;\nretract;\nENDPROC\nPROC other()\n%\"retract\"%;\nENDPROC\n"
      "FUNC num measure()\nretract;\nRETURN 1;\nENDFUNC\nPROC measured()\nn:=measure();\nENDPROC\n";
  const auto behind = [&](const std::string& statement) {
    const Program program = read_rapid(
        module_of(declarations, "MoveJ p1,v100,fine,tool0;\n" + statement + "MoveL p1,v100,z1,tool0;\n"));
    return program;
  };
  for (const char* statement : {"coolant;\n", "lubricate;\n", "IF on coolant;\n", "lower;\n"}) {
    CAPTURE(statement);
    CHECK(all_known(behind(statement).moves.back().known_start));
  }
  for (const char* statement :
       {"retract;\n", "away;\n", "other;\n", "measured;\n", "mode;\n", "elsewhere;\n"}) {
    CAPTURE(statement);
    const Program program = behind(statement);
    CHECK(!program.moves.back().known_start[0]);
    CHECK(program.left_alone.back().why.ends_with("may move the robot"));
  }
  const Program lowered = behind("lower;\nMoveL p2,v100,z1,tool0;\n");
  CHECK(lowered.left_alone.back().why == "the target 'p2' is computed at run time in line 16");
}

TEST_CASE(
    "a routine that does not move the robot keeps its position, also in a module that is read in windows") {
  const std::string motion = "MoveJ " + target_at("1,2,3") + ",v100,fine,tool0;\n";
  const std::string declarations =
      "PROC coolant()\nIF on THEN\nSetDO do1,1;\nELSE\nlubricate;\nENDIF\nTPWrite \"on\";\nENDPROC\n"
      "PROC lubricate()\nSet do2;\nENDPROC\nPROC retract()\n" +
      motion +
      "ENDPROC\nPROC mode()\nConfL\\Off;\nENDPROC\n"
      "PROC away()\nlubricate;\nretract;\nENDPROC\n";
  const std::vector<std::string> still{"coolant;\n", "lubricate;\n", "last;\n"},
      moving{"retract;\n", "away;\n", "mode;\n", "elsewhere;\n", "beyond;\n"};
  const auto check = [&](const std::string& call, bool is_known) {
    CAPTURE(call);
    std::string text =
        module_of(declarations, motion + call + "MoveL " + target_at("4,5,6") + ",v100,z1,tool0;\n");
    text.insert(text.rfind("ENDMODULE"), "PROC last()\ncoolant;\nENDPROC\n");
    text += "MODULE other\nPROC beyond()\nENDPROC\nENDMODULE\n";
    CHECK(!outline_of(text, *find_dialect(abb_name)).named_targets);
    CHECK(all_known(read_rapid(text).moves.back().known_start) == is_known);
  };
  for (const std::string& call : still) check(call, true);
  for (const std::string& call : moving) check(call, false);
}

TEST_CASE("a routine of another RAPID module may cut, also in a module that is read in windows") {
  const std::string motion = "MoveJ " + target_at("1,2,3") + ",v100,fine,tool0;\n";
  for (const std::string declarations : {"", "CONST num n:=1;\nPROC lift(num z)\nENDPROC\n"}) {
    CAPTURE(declarations);
    const auto read = [&](const std::string& call) {
      std::string text = module_of(declarations, motion + call + motion);
      text.insert(text.rfind("ENDMODULE"), "PROC own()\n" + motion + "ENDPROC\n");
      CHECK(outline_of(text, *find_dialect(abb_name)).named_targets == !declarations.empty());
      return read_rapid(text);
    };
    const Program own = read("own;\n"), other = read("other;\n");
    REQUIRE(own.left_alone.size() == 1);
    CHECK_FALSE(own.left_alone[0].feeds);
    CHECK(own.remarks.empty());
    REQUIRE(other.left_alone.size() == 1);
    CHECK(other.left_alone[0].feeds);
    REQUIRE(other.remarks.size() == 1);
    CHECK(other.remarks[0].what.starts_with(
        "assumed from here on: called programs do not change work objects and tools"));
  }
}

TEST_CASE("a function of another RAPID module may cut, as a routine does") {
  const std::string motion = "MoveL " + target_at("1,2,3") + ",v100,z1,tool0;\n";
  const std::string declarations =
      "FUNC num twice(num a)\nRETURN Abs(2*a);\nENDFUNC\nFUNC num deep(num a)\nRETURN f(a);\nENDFUNC\n"
      "FUNC num lift()\nraise;\nRETURN 1;\nENDFUNC\nPROC raise()\n" +
      motion + "ENDPROC\n";
  const auto calls_of = [&](const std::string& statement, const std::string& more) {
    CAPTURE(statement);
    const Program program = read_rapid(module_of(more, motion + statement + motion));
    return std::ranges::count_if(program.left_alone, [](const LeftAlone& block) { return block.feeds; });
  };
  for (const char* statement :
       {"x:=f(5);\n", "x:=1+f (5);\n", "IF f(1)=2 THEN\nENDIF\n", "IF f()=2 x:=1;\n",
        "WHILE f(1)>2 DO\nENDWHILE\n", "FOR i FROM 1 TO f(2) DO\nENDFOR\n", "TEST f(1)\nCASE 1:\nENDTEST\n",
        "WaitUntil f();\n", "TPWrite \"a\"\\Num:=f(2);\n", "y{f(1)}:=2;\n", "SetDO do1,f(1);\n",
        "x:=Abs(f(2));\n"})
    CHECK(calls_of(statement, "") == 1);
  for (const char* statement :
       {"x:=y{1}+(2*a);\n", "x:=Abs(Sin(a)+Pow(2,3)) DIV (2);\n", "IF (a) AND NOT (b) OR (c) THEN\nENDIF\n",
        "p:=CRobT(\\Tool:=tool0\\WObj:=wobj0);\n", "ok:=StrToVal(\"f(1)\",x);\n",
        "x:=UINumEntry(\\Header:=\"a\");\n", "FOR i FROM (1) TO (a) STEP (2) DO\nENDFOR\n",
        "TPWrite(\"call f(1)\");\n", "RETURN (a);\n", "x:=PoseMult(a,PoseInv(b)).trans.x;\n",
        "x:=twice(3);\n"})
    CHECK(calls_of(statement, declarations) == 1);  // of the body of deep
  const auto is_known_behind = [&](const std::string& statement) {
    return all_known(
        read_rapid(module_of(declarations, motion + statement + motion)).moves.back().known_start);
  };
  CHECK(is_known_behind("x:=twice(3);\n"));
  CHECK_FALSE(is_known_behind("x:=deep(3);\n"));
  CHECK_FALSE(is_known_behind("x:=lift();\n"));
  CHECK(calls_of("IF f()=2 THEN\nENDIF\n", "PROC lift()\n" + motion + "ENDPROC\n") == 1);
}

TEST_CASE("behind a routine of the module CirPathMode is not known if the module sets it") {
  const std::string cut = "MoveJ <0,0,0>,v10,fine,tool0;\n";
  const auto read = [&](const std::string& call) {
    return read_routine("CirPathMode\\ObjectFrame;\n" + call + cut + "MoveC <5,5,0>,<10,0,0>,v10,z1,tool0;\n",
                        "PROC other()\nCirPathMode\\ToolFrame;\nENDPROC\n");
  };
  CHECK(read("").moves.back().arc.has_value());
  const Program unknown = read("other;\n");
  CHECK_FALSE(unknown.moves.back().arc.has_value());
  CHECK(unknown.left_alone.back().why.starts_with("how MoveC turns the tool is not known"));
}

TEST_CASE("bodies, handlers and interrupts are not followed, calls make the position unknown") {
  const Program program = read_routine(
      "MoveJ <0,0,0>,v10,fine,tool0;\n"
      "IF TestDI(a) THEN\nWaitDI a, 0;\nELSEIF b = 1 THEN\nELSE\nENDIF\n"
      "MoveL <1,0,0>,v10,z1,tool0;\n"
      "IF a AND b = 1 MoveL <2,0,0>,v10,z1,tool0;\n"
      "FOR i FROM 1 TO 3 DO MoveL <2,0,0>,v10,z1,tool0; ENDFOR\n"
      "WHILE TRUE DO\nMoveJ <2,0,0>,v10,z1,tool0;\nENDWHILE\n"
      "TEST n\nCASE 1,2: MoveL <2,0,0>,v10,z1,tool0;\nDEFAULT:\nENDTEST\n"
      "MoveJ <3,0,0>,v10,fine,tool0;\n"
      "drill;\n"
      "MoveL <4,0,0>,v10,z1,tool0;\n"
      "again:\n"
      "MoveL <5,0,0>,v10,z1,tool0;\n"
      "ERROR\n"
      "MoveL <6,0,0>,v10,z1,tool0;\n"
      "ENDPROC\n"
      "TRAP stop_it\n"
      "MoveL <7,0,0>,v10,z1,tool0;\n"
      "ENDTRAP\n"
      "PROC drill()\n"
      "MoveL <8,0,0>,v10,z1,tool0;\n");
  std::vector<double> followed;
  for (const Move& move : program.moves)
    if (!move.fixed[0]) followed.push_back(move.end_mm.x());
  CHECK(followed == std::vector<double>{0, 1, 3, 4, 5, 8});
  CHECK(all_known(program.moves[1].known_start));
  for (const Move& move : program.moves)
    if (!move.fixed[0] && move.end_mm.x() > 1) CHECK(!move.known_start[0]);
  std::vector<int> lines;
  for (const LeftAlone& row : program.left_alone) lines.push_back(row.line);
  CHECK(lines == std::vector<int>{10, 13, 20, 25});
}

TEST_CASE("malformed and unsupported RAPID is refused with line and column") {
  CHECK(refusal_of_module("", "MoveL [[1,2],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v10,z1,tool0;\n")
            .starts_with("job.mod:3:7: error: the target is not a robtarget; write position, quaternion"));
  CHECK(refusal_of_module("CONST robtarget p1:=[[1,2,3],[1,0,0,0],[0,0,0,0]];\n", "MoveL p1,v10,z1,tool0;\n")
            .starts_with("job.mod:2:21: error: the target is not a robtarget"));
  CHECK(refusal_of_module("", "MoveL " + target_at("1,2,3", "0,0,0,0") + ",v10,z1,tool0;\n")
            .starts_with("job.mod:3:17: error: the quaternion has length 0.0000; the length must be 1"));
  CHECK(refusal_of_module("", "MoveL " + target_at("1,2,3", "1,1,0,0") + ",v10,z1,tool0;\n")
            .starts_with("job.mod:3:17: error: the quaternion has length 1.4142"));
  CHECK(refusal_of_module("", "MoveL " + target_at("1,2,3") + ",v10,tool0;\n") ==
        "job.mod:3:1: error: MoveL has missing or extra arguments; write MoveL target, speed, zone, tool;");
  CHECK(refusal_of_module("", "MoveC " + target_at("1,2,3") + ",v10,z1,tool0;\n")
            .starts_with(
                "job.mod:3:1: error: MoveC has missing or extra arguments; write MoveC point, target"));
  CHECK(refusal_of_module("", "MoveL " + target_at("1,2,3") + ",v10,\nz1,tool0;\n")
            .starts_with("job.mod:3:1: error: the motion does not end in its line"));
  CHECK(refusal_of_module("", "MoveL " + target_at("1,2,3") + ",v10,z1,tool0\n")
            .starts_with("job.mod:3:1: error: the motion does not end in its line"));
  CHECK(refusal_of_module("", "Set do1; MoveL " + target_at("1,2,3") + ",v10,z1,tool0;\n")
            .starts_with("job.mod:3:10: error: the line has a motion and another statement"));
  CHECK(refusal_of_module("", "MoveL " + target_at("1,2,3") + ",v10,z1,tool0; Set do1;\n")
            .starts_with("job.mod:3:1: error: the line has a motion and another statement"));
  CHECK(refusal_of_module("", "PDispOn p1, tool0;\n")
            .starts_with("job.mod:3:1: error: PDispOn displaces the targets"));
  CHECK(refusal_of_module("", "<<<<<<< HEAD\n")
            .starts_with("job.mod:3:1: error: '<<<<<<<' is a conflict marker"));
  const std::string held = "PERS wobjdata part:=[TRUE,TRUE,\"\",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n";
  CHECK(
      refusal_of_module(held, "MoveL " + target_at("1,2,3") + ",v10,z1,tool0\\WObj:=part;\n")
          .starts_with("job.mod:4:71: error: 'part' moves the workpiece to a fixed tool (robhold of the work "
                       "object)"));
  const std::string fixed = "PERS tooldata drill:=[FALSE,[[0,0,0],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n";
  CHECK(refusal_of_module(fixed, "MoveJ " + target_at("1,2,3") + ",v10,z1,drill;\n")
            .find("'DRILL' moves the workpiece") != std::string::npos);
  CHECK(diagnostic_of([] {
          read_rapid("MODULE a\nFUNC num f()\nMoveL p,v1,z1,tool0;\nENDFUNC\nENDMODULE\n");
        }).starts_with("job.mod:3:1: error: a function that moves the robot"));
}

TEST_CASE("a number with an expression is not followed, and is not an error") {
  const Program program =
      read_routine("MoveL [[1+1,2,3],[1,0,0,0],[0,0,0,0],[0,9E9,9E9,9E9,9E9,9E9]],v10,z1,tool0;\n");
  CHECK(program.moves[0].fixed[0]);
  CHECK(program.left_alone[0].why == "the target is computed at run time");
}

TEST_CASE("a module with inline targets alone is read in windows, others as a whole") {
  const auto is_whole = [](const std::string& text) {
    return outline_of(text, *find_dialect("abb")).named_targets;
  };
  const std::string move = "MoveL " + target_at("1,2,3") + ",v10,z1,tool0;\n";
  CHECK(is_whole(module_of("CONST zonedata z:=[TRUE,0,0,0,0,0,0];\n", move)));  // it declares a zone
  CHECK(
      !is_whole(module_of("VAR speeddata s:=[1,2,3,4];\n", "TPWrite \"a\"\\Num:=x;\n" + move + "drill;\n")));
  CHECK(is_whole(module_of("CONST robtarget p:=" + target_at("1,2,3") + ";\n", move)));
  CHECK(is_whole(module_of("", move + "x:=5;\n")));
  CHECK(is_whole(module_of("", "VAR speeddata s:=[1,2,3,4];\n" + move)));
  CHECK(is_whole(module_of("", "drill x;\n" + move)));
  CHECK(is_whole(module_of("", "Incr x;\n" + move)));
  CHECK(is_whole(module_of("", "IF drilled(x) THEN\nENDIF\n" + move)));
  CHECK(is_whole(module_of("", "SetDataVal \"s\",5;\n" + move)));
  CHECK(is_whole(module_of("", move + "ENDPROC\nFUNC num abs()\n")));
  CHECK(!is_whole(module_of("", "IF TestDI(x) THEN\nWaitDI x,1\\MaxTime:=5;\nENDIF\n" + move)));
  CHECK(is_whole(module_of("VAR num x:=\n5;\n", move)));
  CHECK(is_whole(module_of("", move + "ENDPROC\nPROC two(num a)\n")));
}

TEST_CASE("windows of an ABB program have the moves of the whole") {
  std::string statements = "MoveJ " + target_at("0,0,0") + ",v1000,fine,t\\WObj:=w;\n";
  for (int i = 1; i < 40; ++i)
    statements += "MoveL " + target_at(std::to_string(i) + ",0,0") + (i % 9 == 0 ? ",s,fine" : ",s,z1") +
                  ",t\\WObj:=w;\n";
  const std::string text = module_of(
      "VAR speeddata s:=[20,2,3,4];\nPERS wobjdata "
      "w:=[FALSE,TRUE,\"\",[[9,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n",
      statements);
  const Program whole = read_rapid(text);
  FileReader bytes = FileReader::of_bytes(text);
  ProgramReader reader(bytes, "job.mod", {}, 8);
  std::size_t read = 0, windows = 0;
  while (reader.next()) {
    ++windows;
    for (const Move& move : reader.window().moves) {
      const Move& same = whole.moves[read++];
      CHECK(move.end_mm == same.end_mm);
      CHECK(move.start_mm == same.start_mm);
      CHECK(move.feed_mm_min == same.feed_mm_min);
      CHECK(reader.window().frames[move.frame].pose_mm->p == Vector3(9, 0, 0));
    }
  }
  CHECK(read == whole.moves.size());
  CHECK(windows > 2);
}

TEST_CASE("each ABB program of a folder of real programs is reproduced or refused with its line") {
  check_corpus([](const std::filesystem::path& path) { return path.filename().string().starts_with("abb_"); },
               text_of_file);
}
