#include "program/siemens/names.hpp"

#include <algorithm>
#include <array>

#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

struct SiemensName {
  std::string_view name;
  Statement statement;
};

constexpr std::array siemens_names{
    SiemensName{"TRANS", Statement::shift},
    SiemensName{"ROT", Statement::turn},
    SiemensName{"ROTS", Statement::frame},
    SiemensName{"SCALE", Statement::frame},
    SiemensName{"MIRROR", Statement::frame},
    SiemensName{"ATRANS", Statement::added_shift},
    SiemensName{"AROT", Statement::added_turn},
    SiemensName{"AROTS", Statement::added_frame},
    SiemensName{"ASCALE", Statement::added_frame},
    SiemensName{"AMIRROR", Statement::added_frame},
    SiemensName{"CYCLE800", Statement::tilt},
    SiemensName{"TRAORI", Statement::transformed},
    SiemensName{"TRANSMIT", Statement::transformed},
    SiemensName{"TRACYL", Statement::transformed},
    SiemensName{"TRAANG", Statement::transformed},
    SiemensName{"TRAFOOF", Statement::transform_off},
    SiemensName{"MCALL", Statement::modal_call},
    SiemensName{"CYCLE832", Statement::smoothed},
    SiemensName{"COMPCAD", Statement::smoothed},
    SiemensName{"COMPCURV", Statement::smoothed},
    SiemensName{"COMPON", Statement::smoothed},
    SiemensName{"COMPSURF", Statement::smoothed},
    SiemensName{"ASPLINE", Statement::curve},
    SiemensName{"BSPLINE", Statement::curve},
    SiemensName{"CSPLINE", Statement::curve},
    SiemensName{"POLY", Statement::curve},
    SiemensName{"CIP", Statement::curve},
    SiemensName{"CT", Statement::curve},
    SiemensName{"INVCW", Statement::curve},
    SiemensName{"INVCCW", Statement::curve},
    SiemensName{"RET", Statement::end},
};

constexpr std::array harmless_names{
    "MSG",       "STOPRE",   "FFWON",     "FFWOF",       "SOFT",      "BRISK",    "DRIVE",      "CUT2D",
    "CUT2DF",    "COMPOF",   "NORM",      "KONT",        "KONTC",     "KONTT",    "FGROUP",     "FGREF",
    "FTOCON",    "FTOCOF",   "WORKPIECE", "SPOS",        "SPCON",     "SPCOF",    "SETMS",      "DISPLOF",
    "DISPLON",   "SAVE",     "SBLOF",     "SBLON",       "UPATH",     "SPATH",    "CFC",        "CFTCP",
    "CFIN",      "FIFOCTRL", "WALIMON",   "WALIMOF",     "DYNNORM",   "DYNPOS",   "DYNROUGH",   "DYNSEMIFIN",
    "DYNFINISH", "DYNPREC",  "ORISOF",    "ORISON",      "ORIWKS",    "ORIMKS",   "ORIAXES",    "ORIVECT",
    "CTOL",      "OTOL",     "ATOL",      "OVR",         "OVRA",      "OVRRAP",   "FL",         "FA",
    "FRC",       "FRCM",     "FB",        "FZ",          "SCC",       "SVC",      "ADIS",       "ADISPOS",
    "DISC",      "ACC",      "LIMS",      "VELOLIM",     "JERKLIM",   "RTLION",   "RTLIOF",     "DEF",
    "DEFINE",    "EXTERN",   "PROC",      "GROUP_BEGIN", "GROUP_END", "GOTO",     "GOTOF",      "GOTOB",
    "GOTOC",     "GOTOS",    "CASE",      "SPINDLE",     "SYNFCT",    "STOPREC",  "FNORM",      "CPRECON",
    "CPRECOF",   "WAITM",    "WAITMC",    "WAITE",       "WAITS",     "SETM",     "CLEARM",     "SETAL",
    "STARTFIFO", "STOPFIFO", "SPOSA",     "SOFTA",       "BRISKA",    "DRIVEA",   "DELAYFSTON", "DELAYFSTOF",
    "FINEA",     "COARSEA",  "IPOENDA",   "IPOBRKA",     "ACCLIMA",   "VELOLIMA", "JERKLIMA",   "SCPARA",
    "DIAMOF",    "TOROTOF",  "PAROTOF",   "CDON",        "CDOF",      "CDOF2",    "OSOF",       "OSC",
    "OSS",       "OSSE",     "OSD",       "OST",
};

constexpr std::array tool_offset_names{"TOFF", "TOFFL", "TOFFR", "TOFFLR", "TCARR", "DL"};

constexpr std::array speed_names{"FB", "FZ", "OVR", "SVC", "SETMS", "SPOS", "SPOSA", "FGROUP"};

constexpr std::array<std::string_view, 17> harmless_variables{"$AC_TIMER",
                                                              "$AC_MARKER",
                                                              "$AC_PARAM",
                                                              "$AC_OPERATING_TIME",
                                                              "$AC_CYCLE_TIME",
                                                              "$AC_CUTTING_TIME",
                                                              "$AC_REQUIRED_PARTS",
                                                              "$AC_TOTAL_PARTS",
                                                              "$AC_ACTUAL_PARTS",
                                                              "$AC_SPECIAL_PARTS",
                                                              "$A_OUT",
                                                              "$A_OUTA",
                                                              "$A_DBB",
                                                              "$A_DBW",
                                                              "$A_DBD",
                                                              "$A_DBR",
                                                              "$A_DLB"};

constexpr std::array<std::string_view, 13> structures{"IF",    "ELSE",    "ENDIF", "WHILE",   "ENDWHILE",
                                                      "FOR",   "ENDFOR",  "LOOP",  "ENDLOOP", "REPEAT",
                                                      "UNTIL", "REPEATB", "PROC"};

constexpr std::array position_names{"AP", "RP", "AR", "OFFN", "RNDM", "DISR", "DISCL", "POS", "POSA", "FP"};

constexpr std::array<std::string_view, 9> operators{"DIV",   "MOD",  "AND",   "OR", "XOR",
                                                    "B_AND", "B_OR", "B_XOR", "NOT"};

constexpr std::array<std::string_view, 5> cycle_families{"CYCLE", "POCKET", "HOLES", "SLOT", "LONGHOLE"};

}  // namespace

std::optional<Statement> statement_of_name(std::string_view name) {
  for (const SiemensName& known : siemens_names)
    if (is_word(name, known.name)) return known.statement;
  return std::nullopt;
}

bool is_harmless_name(std::string_view name) {
  return is_one_of(name, harmless_names);
}

bool is_speed_name(std::string_view name) {
  return is_one_of(name, speed_names);
}

bool is_harmless_variable(std::string_view name) {
  return is_one_of(name, harmless_variables);
}

bool is_siemens_structure(std::string_view name) {
  return is_one_of(name, structures);
}

bool is_position_name(std::string_view name) {
  return is_one_of(name, position_names);
}

bool is_tool_offset_name(std::string_view name) {
  return is_one_of(name, tool_offset_names);
}

bool is_siemens_operator(std::string_view name) {
  return is_one_of(name, operators);
}

bool is_cycle_name(std::string_view name) {
  const std::string_view family = name.substr(0, name.find_last_not_of("0123456789") + 1);
  return is_one_of(family, cycle_families);
}

}  // namespace counterflex
