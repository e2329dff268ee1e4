// Names of RAPID instructions.
#include <array>

#include "program/robot/rapid/module.hpp"

namespace counterflex {
namespace {

/// All but `writing_instructions` only read their arguments, apart from `options_with_result`: ABB, RAPID
/// Instructions, Functions and Data types, 3HAC16581. Motions do not use the clocks, files and sockets that
/// some of them change.
constexpr auto motionless_instructions = std::to_array<std::string_view>({
    "ACCSET",        "ACTUNIT",      "ADD",
    "BITCLEAR",      "BITSET",       "BREAK",
    "CIRPATHMODE",   "CLEAR",        "CLEARIOBUFF",
    "CLEARPATH",     "CLKRESET",     "CLKSTART",
    "CLKSTOP",       "CLOSE",        "CONFJ",
    "CONFL",         "CONNECT",      "CORNERPATHWARNING",
    "DEACTUNIT",     "DECR",         "EOFFSOFF",
    "ERRLOG",        "ERRWRITE",     "EXIT",
    "EXITCYCLE",     "GOTO",         "GRIPLOAD",
    "IDELETE",       "IDISABLE",     "IENABLE",
    "INCR",          "INVERTDO",     "IODISABLE",
    "IOENABLE",      "ISIGNALDI",    "ISIGNALDO",
    "ISLEEP",        "ITIMER",       "IWATCH",
    "LOAD",          "MOTIONSUP",    "OPEN",
    "PATHACCLIM",    "PATHRESOL",    "PDISPOFF",
    "PULSEDO",       "RAISE",        "RESET",
    "RETRY",         "RETURN",       "REWIND",
    "SET",           "SETAO",        "SETDO",
    "SETGO",         "SINGAREA",     "SOCKETCLOSE",
    "SOCKETCONNECT", "SOCKETCREATE", "SOCKETSEND",
    "SPEEDREFRESH",  "STOP",         "SYSTEMSTOPACTION",
    "TPERASE",       "TPSHOW",       "TPWRITE",
    "TRYNEXT",       "UIMSGBOX",     "UNLOAD",
    "VELSET",        "WAITAI",       "WAITAO",
    "WAITDI",        "WAITDO",       "WAITGI",
    "WAITGO",        "WAITROB",      "WAITTIME",
    "WAITUNTIL",     "WORLDACCLIM",  "WRITE",
    "WRITEBIN",      "WRITESTRBIN",
});

/// Motionless instructions that write an argument.
constexpr auto writing_instructions =
    std::to_array<std::string_view>({"ADD", "BITCLEAR", "BITSET", "CLEAR", "CONNECT", "DECR", "INCR"});

/// Instructions that set how later motions run.
constexpr auto mode_instructions =
    std::to_array<std::string_view>({"CIRPATHMODE", "CONFJ", "CONFL", "SINGAREA", "VELSET"});

/// Functions that only read their arguments. StrToVal, DefAccFrame and TestAndSet write one.
constexpr auto reading_functions = std::to_array<std::string_view>(
    {"ABS",       "ACOS",      "AINPUT",    "AOUTPUT",     "ASIN",           "ATAN",
     "ATAN2",     "BITAND",    "BITCHECK",  "BITLSH",      "BITNEG",         "BITOR",
     "BITRSH",    "BITXOR",    "BYTETOSTR", "CALCROBT",    "CDATE",          "CJOINTT",
     "CLKREAD",   "COS",       "CPOS",      "CROBT",       "CSPEEDOVERRIDE", "CTIME",
     "CTOOL",     "CWOBJ",     "DEFFRAME",  "DIM",         "DINPUT",         "DISTANCE",
     "DNUMTONUM", "DNUMTOSTR", "DOTPROD",   "DOUTPUT",     "EULERZYX",       "EXP",
     "FILESIZE",  "GETTIME",   "GINPUT",    "GINPUTDNUM",  "GOUTPUT",        "GOUTPUTDNUM",
     "ISFILE",    "ISPERS",    "ISVAR",     "MAXROBSPEED", "MIRPOS",         "NORIENT",
     "NUMTODNUM", "NUMTOSTR",  "OFFS",      "OPMODE",      "ORIENTZYX",      "OROBT",
     "POSEINV",   "POSEMULT",  "POSEVECT",  "POW",         "PRESENT",        "RELTOOL",
     "ROBOS",     "ROUND",     "RUNMODE",   "SIN",         "SQRT",           "STRFIND",
     "STRLEN",    "STRMAP",    "STRMATCH",  "STRMEMB",     "STRORDER",       "STRPART",
     "STRTOBYTE", "TAN",       "TESTDI",    "TRUNC",       "VALTOSTR",       "VECTMAGN"});

/// The instructions write the variable of these options: "WaitDI start, 1\MaxTime:=5\TimeFlag:=late;".
constexpr auto options_with_result =
    std::to_array<std::string_view>({"BREAKFLAG", "DVALUEATTIMEOUT", "RESULT", "TIMEFLAG", "VALUEATTIMEOUT"});

constexpr auto linear_instructions = std::to_array<std::string_view>(
    {"MOVELAO",   "MOVELDO",   "MOVELGO", "MOVELSYNC", "MOVECAO", "MOVECDO", "MOVECGO",
     "MOVECSYNC", "TRIGGL",    "TRIGGC",  "TRIGGLIOS", "SEARCHL", "SEARCHC", "ARCL",
     "ARCC",      "ARCLSTART", "ARCLEND", "ARCCSTART", "ARCCEND", "SPOTL",   "SPOTML",
     "PAINTL",    "PAINTC",    "DISPL",   "DISPC",     "CAPL",    "CAPC"});

constexpr auto joint_instructions =
    std::to_array<std::string_view>({"MOVEABSJ", "MOVEEXTJ", "MOVEJAO", "MOVEJDO", "MOVEJGO", "MOVEJSYNC",
                                     "TRIGGJ", "TRIGGABSJ", "SPOTJ", "SPOTMJ"});

bool is_move(std::string_view name) {
  return is_among(name, std::to_array<std::string_view>({"MOVEL", "MOVEJ", "MOVEC", "MOVEABSJ"}));
}

}  // namespace

bool is_motionless_instruction(std::string_view name) {
  return is_among(name, motionless_instructions);
}

bool is_mode_instruction(std::string_view name) {
  return is_among(name, mode_instructions);
}

bool only_reads(std::string_view name) {
  if (is_motionless_instruction(name)) return !is_among(name, writing_instructions);
  return is_among(name, reading_functions) || is_move(name);
}

bool is_option_with_result(std::string_view name) {
  return is_among(name, options_with_result);
}

bool is_linear_instruction(std::string_view name) {
  return is_among(name, linear_instructions);
}

bool is_joint_instruction(std::string_view name) {
  return is_among(name, joint_instructions);
}

}  // namespace counterflex
