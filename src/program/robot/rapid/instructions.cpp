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

/// Functions that only read their arguments.
constexpr auto reading_functions = std::to_array<std::string_view>({
    "ABS",
    "ABSDNUM",
    "ACOS",
    "ACOSDNUM",
    "AINPUT",
    "AOUTPUT",
    "ARGNAME",
    "ASIN",
    "ASINDNUM",
    "ATAN",
    "ATAN2",
    "ATAN2DNUM",
    "ATANDNUM",
    "BITAND",
    "BITANDDNUM",
    "BITCHECK",
    "BITCHECKDNUM",
    "BITLSH",
    "BITLSHDNUM",
    "BITNEG",
    "BITNEGDNUM",
    "BITOR",
    "BITORDNUM",
    "BITRSH",
    "BITRSHDNUM",
    "BITXOR",
    "BITXORDNUM",
    "BYTETOSTR",
    "CALCJOINTT",
    "CALCROBT",
    "CAMGETEXPOSURE",
    "CAMGETLOADEDJOB",
    "CAMGETNAME",
    "CAMNUMBEROFRESULTS",
    "CDATE",
    "CJOINTT",
    "CLKREAD",
    "CORRREAD",
    "COS",
    "COSDNUM",
    "CPOS",
    "CROBT",
    "CROSSPROD",
    "CSPEEDOVERRIDE",
    "CTIME",
    "CTOOL",
    "CWOBJ",
    "DECTOHEX",
    "DEFDFRAME",
    "DEFFRAME",
    "DIM",
    "DINPUT",
    "DISTANCE",
    "DNUMTONUM",
    "DNUMTOSTR",
    "DOTPROD",
    "DOUTPUT",
    "EGMGETSTATE",
    "EULERZYX",
    "EVENTTYPE",
    "EXECHANDLER",
    "EXECLEVEL",
    "EXP",
    "FCGETFORCE",
    "FCISFORCEMODE",
    "FILESIZE",
    "FILETIME",
    "FILETIMEDNUM",
    "FSSIZE",
    "GETAXISDISTANCE",
    "GETAXISMOVETIME",
    "GETMAXNUMBEROFCYCLICBOOL",
    "GETMECUNITNAME",
    "GETMODALPAYLOADMODE",
    "GETMOTORTORQUE",
    "GETNUMBEROFCYCLICBOOL",
    "GETSERVICEINFO",
    "GETSIGNAL",
    "GETSIGNALDNUM",
    "GETSYSINFO",
    "GETTIME",
    "GETTSPSTATUS",
    "GETUASUSERNAME",
    "GINPUT",
    "GINPUTDNUM",
    "GOUTPUT",
    "GOUTPUTDNUM",
    "HEXTODEC",
    "INDINPOS",
    "INDSPEED",
    "IOUNITSTATE",
    "ISBRAKECHECKACTIVE",
    "ISCYCLICBOOL",
    "ISFILE",
    "ISLEADTHROUGH",
    "ISMECHUNITACTIVE",
    "ISPERS",
    "ISSTOPMOVEACT",
    "ISSTOPSTATEEVENT",
    "ISSYNCMOVEON",
    "ISSYSID",
    "ISVAR",
    "MAX",
    "MAXEXTLINEARSPEED",
    "MAXEXTREORIENTSPEED",
    "MAXROBREORIENTSPEED",
    "MAXROBSPEED",
    "MIN",
    "MIRPOS",
    "MODEXIST",
    "MODTIME",
    "MODTIMEDNUM",
    "MOTIONPLANNERNO",
    "NONMOTIONMODE",
    "NORIENT",
    "NUMTODNUM",
    "NUMTOSTR",
    "OFFS",
    "OPMODE",
    "ORIENTZYX",
    "OROBT",
    "PATHLENGTHGET",
    "PATHLEVEL",
    "PATHRECVALIDBWD",
    "PATHRECVALIDFWD",
    "PFRESTART",
    "POSEINV",
    "POSEMULT",
    "POSEVECT",
    "POW",
    "POWDNUM",
    "PPMOVEDINMANMODE",
    "PRESENT",
    "PROGMEMFREE",
    "RAWBYTESLEN",
    "READBIN",
    "READMOTOR",
    "READNUM",
    "READSTR",
    "READSTRBIN",
    "READVAR",
    "RELTOOL",
    "REMAININGRETRIES",
    "RMQGETSLOTNAME",
    "ROBNAME",
    "ROBOS",
    "ROUND",
    "ROUNDDNUM",
    "RUNMODE",
    "SIN",
    "SINDNUM",
    "SOCKETGETSTATUS",
    "SOCKETPEEK",
    "SQRT",
    "SQRTDNUM",
    "STRDIGCALC",
    "STRDIGCMP",
    "STRFIND",
    "STRLEN",
    "STRMAP",
    "STRMATCH",
    "STRMEMB",
    "STRORDER",
    "STRPART",
    "STRTOBYTE",
    "TAN",
    "TANDNUM",
    "TASKISACTIVE",
    "TASKISEXECUTING",
    "TASKRUNMEC",
    "TASKRUNROB",
    "TESTDI",
    "TESTSIGNREAD",
    "TEXTGET",
    "TEXTTABFREETOUSE",
    "TEXTTABGET",
    "TRIGGDATAVALID",
    "TRUNC",
    "TRUNCDNUM",
    "TYPE",
    "UIALPHAENTRY",
    "UICLIENTEXIST",
    "UIDNUMENTRY",
    "UIDNUMTUNE",
    "UILISTVIEW",
    "UIMESSAGEBOX",
    "UINUMENTRY",
    "UINUMTUNE",
    "VALIDIO",
    "VALTOSTR",
    "VECTMAGN",
});

/// Functions that write an argument.
constexpr auto writing_functions = std::to_array<std::string_view>(
    {"CALCROTAXFRAMEZ", "CALCROTAXISFRAME", "DEFACCFRAME", "GETNEXTCYCLICBOOL", "GETNEXTMECHUNIT",
     "GETNEXTSYM", "GETSIGNALORIGIN", "GETTASKNAME", "PARIDPOSVALID", "PARIDROBVALID", "READDIR", "STRTOVAL",
     "TASKSINSYNC", "TESTANDSET"});

/// The instructions write the variable of these options: "WaitDI start, 1\MaxTime:=5\TimeFlag:=late;".
constexpr auto options_with_result = std::to_array<std::string_view>(
    {"BREAKFLAG", "DVALUEATTIMEOUT", "ERRORNUMBER", "RESULT", "TIMEFLAG", "VALUEATTIMEOUT"});

constexpr auto linear_instructions = std::to_array<std::string_view>(
    {"MOVELAO",   "MOVELDO",   "MOVELGO", "MOVELSYNC", "MOVECAO", "MOVECDO", "MOVECGO",
     "MOVECSYNC", "TRIGGL",    "TRIGGC",  "TRIGGLIOS", "SEARCHL", "SEARCHC", "ARCL",
     "ARCC",      "ARCLSTART", "ARCLEND", "ARCCSTART", "ARCCEND", "SPOTL",   "SPOTML",
     "PAINTL",    "PAINTC",    "DISPL",   "DISPC",     "CAPL",    "CAPC"});

constexpr auto joint_instructions =
    std::to_array<std::string_view>({"MOVEABSJ", "MOVEEXTJ", "MOVEJAO", "MOVEJDO", "MOVEJGO", "MOVEJSYNC",
                                     "TRIGGJ", "TRIGGABSJ", "SPOTJ", "SPOTMJ"});

/// Motions that only read their arguments.
constexpr auto reading_moves = std::to_array<std::string_view>(
    {"MOVEL",     "MOVELAO",  "MOVELDO",   "MOVELGO", "MOVELSYNC", "MOVEC",   "MOVECAO",
     "MOVECDO",   "MOVECGO",  "MOVECSYNC", "MOVEJ",   "MOVEJAO",   "MOVEJDO", "MOVEJGO",
     "MOVEJSYNC", "MOVEABSJ", "MOVEEXTJ",  "TRIGGL",  "TRIGGC",    "TRIGGJ",  "TRIGGABSJ"});

}  // namespace

bool is_motionless_instruction(std::string_view name) {
  return is_among(name, motionless_instructions);
}

bool is_mode_instruction(std::string_view name) {
  return is_among(name, mode_instructions);
}

bool is_motionless_function(std::string_view name) {
  return is_among(name, reading_functions) || is_among(name, writing_functions);
}

bool only_reads(std::string_view name) {
  if (is_motionless_instruction(name)) return !is_among(name, writing_instructions);
  return is_among(name, reading_functions) || is_among(name, reading_moves);
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
