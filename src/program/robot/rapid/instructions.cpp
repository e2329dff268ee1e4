// Names of RAPID instructions.
#include <array>

#include "program/robot/rapid/module.hpp"

namespace counterflex {
namespace {

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

constexpr auto linear_instructions = std::to_array<std::string_view>(
    {"MOVELAO",   "MOVELDO",   "MOVELGO", "MOVELSYNC", "MOVECAO", "MOVECDO", "MOVECGO",
     "MOVECSYNC", "TRIGGL",    "TRIGGC",  "TRIGGLIOS", "SEARCHL", "SEARCHC", "ARCL",
     "ARCC",      "ARCLSTART", "ARCLEND", "ARCCSTART", "ARCCEND", "SPOTL",   "SPOTML",
     "PAINTL",    "PAINTC",    "DISPL",   "DISPC",     "CAPL",    "CAPC"});

constexpr auto joint_instructions =
    std::to_array<std::string_view>({"MOVEABSJ", "MOVEEXTJ", "MOVEJAO", "MOVEJDO", "MOVEJGO", "MOVEJSYNC",
                                     "TRIGGJ", "TRIGGABSJ", "SPOTJ", "SPOTMJ"});

}  // namespace

bool is_motionless_instruction(std::string_view name) {
  return is_among(name, motionless_instructions);
}

bool is_linear_instruction(std::string_view name) {
  return is_among(name, linear_instructions);
}

bool is_joint_instruction(std::string_view name) {
  return is_among(name, joint_instructions);
}

}  // namespace counterflex
