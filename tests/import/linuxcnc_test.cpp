#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "counterflex/import/import.hpp"
#include "counterflex/machine/parameters.hpp"
#include "counterflex/statics/nominal.hpp"
#include "import/arm_poses.hpp"

namespace counterflex::import_linuxcnc_test {
namespace {

struct Link {
  double a, alpha, d;  // mm, rad
};
constexpr std::array<Link, 6> arm = {{{0, 0, 350},
                                      {85, -1.570796326, 0},
                                      {380, 0.001, -2.5},
                                      {100, -1.570796326, 425},
                                      {0, 1.570796326, 0},
                                      {3, -1.571, 85}}};

std::string serial_pins(const std::string& more = "") {
  std::string text = "loadrt genserkins\n# geometry\n";
  char line[200];
  for (std::size_t i = 0; i < arm.size(); ++i) {
    std::snprintf(
        line, sizeof line,
        "setp genserkins.A-%zu %.17g\nsetp genserkins.ALPHA-%zu %.17g\nsetp genserkins.D-%zu %.17g # mm\n", i,
        arm[i].a, i, arm[i].alpha, i, arm[i].d);
    text += line;
  }
  return text + more;
}

const std::string arm_ini = R"([EMC]
MACHINE = bench arm
[KINS]
KINEMATICS = genserkins
JOINTS = 6
[TRAJ]
LINEAR_UNITS = inch
ANGULAR_UNITS = degree
[JOINT_0]
MIN_LIMIT = -170.0
MAX_LIMIT = 170.0
[JOINT_1]
MIN_LIMIT = -85
MAX_LIMIT = 50  # to the front
[HAL]
HALFILE = LIB:basic_sim.tcl
HALFILE = arm.hal
HALFILE = panel.tcl
)";

/// genserkins: Rx(alpha) Tx(a) Rz(theta) Tz(d) per joint, theta = joint - unrotate * theta before; `unit` in
/// m.
Pose serial_pose(const std::vector<double>& joints, const std::array<int, 6>& unrotate, double unit) {
  Pose X;
  double before = 0;
  for (std::size_t i = 0; i < arm.size(); ++i) {
    const double theta = joints[i] - (i > 0 ? unrotate[i] * before : 0);
    before = theta;
    const double ct = std::cos(theta), st = std::sin(theta), ca = std::cos(arm[i].alpha),
                 sa = std::sin(arm[i].alpha);
    Pose link;
    link.R << ct, -st, 0, st * ca, ct * ca, -sa, st * sa, ct * sa, ca;
    link.p = unit * Vector3(arm[i].a, -sa * arm[i].d, ca * arm[i].d);
    X = X * link;
  }
  return X;
}

constexpr std::array<std::array<double, 3>, 6> base = {
    {{-600, 110, 5}, {600, 110, 0}, {400, 440, 0}, {210, -570, -3}, {-200, -570, 0}, {-390, 450, 0}}};
constexpr std::array<std::array<double, 3>, 6> platform = {
    {{-180, 150, 0}, {180, 150, 1}, {50, 240, 0}, {200, -120, 0}, {-210, -120, -2}, {-40, 240, 0}}};

std::string hexapod_pins(const std::string& more = "") {
  std::string text;
  char line[120];
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      std::snprintf(line, sizeof line, "setp genhexkins.base.%zu.%c %g\nsetp genhexkins.platform.%zu.%c %g\n",
                    i, "xyz"[k], base[i][k], i, "xyz"[k], platform[i][k]);
      text += line;
    }
  return text + more;
}

/// genhexkins: the distances of the platform's joints from those of the base (m).
std::vector<double> strut_lengths(const Pose& X, double spindle_offset_mm) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < 6; ++i) {
    const Vector3 a(platform[i][0], platform[i][1], platform[i][2] + spindle_offset_mm);
    const Vector3 b(base[i][0], base[i][1], base[i][2] + spindle_offset_mm);
    lengths.push_back((X * (a * mm) - b * mm).norm());
  }
  return lengths;
}

const std::string mill_ini = R"([EMC]
MACHINE = knee mill
[KINS]
KINEMATICS = trivkins coordinates=xyyza
JOINTS = 5
[TRAJ]
LINEAR_UNITS = inch
[JOINT_0]
TYPE = LINEAR
MIN_LIMIT = -1
MAX_LIMIT = 29
[JOINT_1]
TYPE = LINEAR
MIN_LIMIT = 0
MAX_LIMIT = 16
[JOINT_3]
TYPE = LINEAR
MIN_LIMIT = -20
MAX_LIMIT = 0.1
)";

std::string message_of(const std::vector<ConfigurationFile>& files) {
  return diagnostic([&] { import_linuxcnc(files); });
}
std::string message_of_hal(const std::string& text) {
  return message_of({{"arm.hal", text}});
}
std::string message_of_ini(const std::string& text) {
  return message_of({{"m.ini", text}});
}

}  // namespace

TEST_CASE("genserkins has the poses of LinuxCNC's formula, in mm and inch") {
  check_poses(import_linuxcnc({{"arm.hal", serial_pins()}}),
              [](const std::vector<double>& q) { return serial_pose(q, {}, mm); });
  check_poses(import_linuxcnc({{"arm.ini", arm_ini}, {"arm.hal", serial_pins()}}),
              [](const std::vector<double>& q) { return serial_pose(q, {}, inch); });
}

TEST_CASE("the unit of length of the INI file is that of programs") {
  const std::string ini_mm =
      "[KINS]\nKINEMATICS = genhexkins\n[TRAJ]\nLINEAR_UNITS = mm\n[HAL]\nHALFILE = h.hal\n";
  const auto units = [](const std::vector<ConfigurationFile>& files) {
    return read_machine(import_linuxcnc(files), "m.toml").control.units;
  };
  CHECK(units({{"arm.hal", serial_pins()}}).empty());
  CHECK(units({{"arm.ini", arm_ini}, {"arm.hal", serial_pins()}}) == "inch");
  CHECK(units({{"mill.ini", mill_ini}}) == "inch");
  const std::string startup = "\n[RS274NGC]\nRS274NGC_STARTUP_CODE = G17 ";
  CHECK(units({{"mill.ini", mill_ini + startup + "G20 G40\n"}}) == "inch");
  CHECK(units({{"mill.ini", mill_ini + startup + "G21 G40\n"}}).empty());
  CHECK(units({{"h.ini", ini_mm}, {"h.hal", hexapod_pins()}}) == "mm");
}

TEST_CASE("the startup code of the INI file is read as LinuxCNC reads it") {
  const auto units = [](const std::string& startup, bool is_inch) {
    const std::string ini = is_inch ? mill_ini : replaced(mill_ini, "inch", "mm");
    return read_machine(import_linuxcnc(
                            {{"mill.ini", ini + "\n[RS274NGC]\nRS274NGC_STARTUP_CODE = " + startup + "\n"}}),
                        "m.toml")
        .control.units;
  };
  for (const char* inch_code :
       {"G20", "g20", "g17g20g40", "G 20", "G020", "g 0 2 0", "G91 G20", "G20.0 g54"}) {
    CAPTURE(inch_code);
    CHECK(units(inch_code, false).empty());
    CHECK(units(inch_code, true) == "inch");
  }
  for (const char* mm_code : {"G21", "g21", "G17G021 G90.1", "g2 1", "G64 P0.01 G21 G94"}) {
    CAPTURE(mm_code);
    CHECK(units(mm_code, true).empty());
    CHECK(units(mm_code, false) == "mm");
  }
  for (const char* other : {"G17 G40 G90 (not G20)", "M64 P20", "G17 ; G20, G21", ""}) {
    CAPTURE(other);
    CHECK(units(other, true) == "inch");
    CHECK(units(other, false) == "mm");
  }
  CHECK(units("o<init> call", false).empty());  // what it sets is not known
  CHECK(units("G17 G[20", false).empty());
}

TEST_CASE("unrotate couples a joint with those before it, as LinuxCNC does") {
  const std::string pins = serial_pins("setp genserkins.unrotate-2 1\nsetp genserkins.unrotate-3 -2\n");
  check_poses(import_linuxcnc({{"arm.hal", pins}}), [](const std::vector<double>& q) {
    return serial_pose(q, {0, 0, 1, -2, 0, 0}, mm);
  });
}

TEST_CASE("travel and name of an arm are those of the INI file") {
  const std::string text = import_linuxcnc({{"arm.ini", arm_ini}, {"arm.hal", serial_pins()}});
  const Machine machine = read_machine(text, "m.toml");
  CHECK(machine.name == "bench arm");
  CHECK(machine.control.dialect == "linuxcnc");
  const std::vector<Actuator> all = actuators(machine);
  CHECK(all[1].min == doctest::Approx(-85 * deg));
  CHECK(all[1].max == doctest::Approx(50 * deg));
  CHECK(all[2].max == std::numeric_limits<double>::infinity());
  CHECK(prepare(machine).home_status == Status::converged);
  CHECK(text.find("lengths are taken to be in mm") == text.npos);
  CHECK(import_linuxcnc({{"arm.hal", serial_pins()}}).find("PLACEHOLDER: lengths are taken to be in mm") !=
        text.npos);
}

TEST_CASE("the HAL files of an INI file are those that it loads from its folder") {
  CHECK(hal_files_of({"arm.ini", arm_ini}) == std::vector<std::string>{"arm.hal"});
}

TEST_CASE("values of a HAL file may be those of the INI file") {
  const std::string pins =
      replaced(serial_pins(), "setp genserkins.D-0 350", "setp genserkins.D-0 [GEOMETRY]D0");
  const std::string ini = arm_ini + "[GEOMETRY]\nD0 = 350\n";
  CHECK(import_linuxcnc({{"arm.ini", ini}, {"arm.hal", pins}}) ==
        import_linuxcnc({{"arm.ini", arm_ini}, {"arm.hal", serial_pins()}}));
  CHECK(message_of_hal(pins) ==
        "arm.hal:5:21: error: [GEOMETRY]D0 is a value of the INI file; import the INI file instead of "
        "this HAL file");
  CHECK(message_of({{"arm.ini", arm_ini}, {"arm.hal", pins}}) ==
        "arm.hal:5:21: error: arm.ini has no [GEOMETRY]D0, which this line needs");
}

TEST_CASE("genhexkins has the strut lengths of LinuxCNC's formula at 1000 random poses") {
  for (const double offset : {0.0, 37.5}) {
    const std::string pins =
        hexapod_pins("setp genhexkins.spindle-offset " + std::to_string(offset) +
                     "\nnet tool-offset genhexkins.tool-offset <= motion.tooloffset.z\n");
    const Machine machine = read_machine(import_linuxcnc({{"hexapod.hal", pins}}), "m.toml");
    const Model model = prepare(machine);
    REQUIRE(model.home_status == Status::converged);
    CHECK(actuator_jacobian(model, model.home).condition < 1e3);
    std::mt19937 random(22);
    std::uniform_real_distribution<double> at(-0.1, 0.1), angle(-0.15, 0.15);
    double largest = 0;
    for (int k = 0; k < 1000; ++k) {
      const Vector3 p(at(random), at(random), at(random)), rpy(angle(random), angle(random), angle(random));
      const Pose X = {from_rpy(rpy), model.home.X_MP.p + p};
      const NominalResult result = follow(model, model.home, X);
      REQUIRE(result.status == Status::converged);
      const Eigen::VectorXd rho = actuator_values(model.mechanism, result.configuration);
      const std::vector<double> lengths = strut_lengths(X, offset);
      for (int i = 0; i < 6; ++i)
        largest = std::max(largest, std::abs(rho[i] - lengths[static_cast<std::size_t>(i)]));
      largest = std::max(largest, difference(tip(model.mechanism, result.configuration), X).norm());
    }
    MESSAGE("largest difference: " << largest << " m");
    CHECK(largest < 1e-9);
  }
}

TEST_CASE("home and travel of a hexapod are those of the INI file") {
  const std::string ini =
      "[KINS]\nKINEMATICS = genhexkins\nJOINTS = 6\n[TRAJ]\nLINEAR_UNITS = mm\nHOME = 0 10 700 0 0 0\n"
      "[JOINT_0]\nMIN_LIMIT = 500\nMAX_LIMIT = 1200\n";
  const Machine machine =
      read_machine(import_linuxcnc({{"h.ini", ini}, {"h.hal", hexapod_pins()}}), "m.toml");
  CHECK((machine.home_X_MP->p - Vector3(0, 0.01, 0.7)).norm() < 1e-15);
  CHECK(actuators(machine)[0].min == doctest::Approx(0.5));
  CHECK(prepare(machine).home_status == Status::converged);
  CHECK(number_sources(machine).prior == 48);
}

TEST_CASE("the orientation at home of a hexapod is that of the INI file") {
  const auto imported = [](const std::string& home) {
    const std::string ini =
        "[KINS]\nKINEMATICS = genhexkins\nJOINTS = 6\n[TRAJ]\nLINEAR_UNITS = mm\nHOME = " + home + "\n";
    return read_machine(import_linuxcnc({{"h.ini", ini}, {"h.hal", hexapod_pins()}}), "m.toml");
  };
  const Machine machine = imported("5 10 700 4 -6 12");
  const Pose wanted{from_rpy(Vector3(4, -6, 12) * deg), Vector3(5, 10, 700) * mm};
  CHECK(difference(*machine.home_X_MP, wanted).norm() < 1e-12);
  const Model model = prepare(machine);
  REQUIRE(model.home_status == Status::converged);
  CHECK(difference(model.home.X_MP, wanted).norm() < 1e-9);
  const Eigen::VectorXd rho = actuator_values(model.mechanism, model.home);
  const std::vector<double> lengths = strut_lengths(wanted, 0);
  for (int i = 0; i < 6; ++i)
    CHECK(rho[i] == doctest::Approx(lengths[static_cast<std::size_t>(i)]).epsilon(1e-9));
  CHECK(difference(*imported("0 0 700 0 0 12").home_X_MP,
                   {from_rpy(Vector3(0, 0, 12) * deg), Vector3(0, 0, 0.7)})
            .norm() < 1e-12);
  for (const char* home : {"0 0 700", "0 0 700 # mm", "0 0 700 ; mm"})
    CHECK(imported(home).home_X_MP->R == Matrix3::Identity());
  const std::string ini = "[KINS]\nKINEMATICS = genhexkins\n[TRAJ]\nLINEAR_UNITS = mm\nHOME = 0 0 700 0 x\n";
  CHECK(message_of({{"h.ini", ini}, {"h.hal", hexapod_pins()}}) ==
        "h.ini:5:8: error: each of the first six numbers of [TRAJ] HOME is 'x'; it must be a finite number");
}

TEST_CASE("trivkins has the axes and the travel of the INI file") {
  const std::string text = import_linuxcnc({{"mill.ini", mill_ini}});
  const Machine machine = read_machine(text, "m.toml");
  CHECK(machine.controlled == std::vector<Component>{Component::x, Component::y, Component::z});
  const std::vector<Actuator> all = actuators(machine);
  REQUIRE(all.size() == 3);
  CHECK(all[0].max == doctest::Approx(29 * inch));
  CHECK(all[1].max == doctest::Approx(16 * inch));
  CHECK(all[2].min == doctest::Approx(-20 * inch));
  CHECK(platform_pose(machine, {0.1, 0.2, -0.3}).p == Vector3(0.1, 0.2, -0.3));
  CHECK(prepare(machine).home_status == Status::converged);
  CHECK(text.find("axes that are left out, because trivkins does not state where they are: A.") != text.npos);
}

TEST_CASE("the travel of an axis with two joints is what both allow") {
  const std::string both = mill_ini + "[JOINT_2]\nMIN_LIMIT = 1\nMAX_LIMIT = 15\n";
  const Actuator y = actuators(read_machine(import_linuxcnc({{"mill.ini", both}}), "m.toml"))[1];
  CHECK(y.min == doctest::Approx(1 * inch));
  CHECK(y.max == doctest::Approx(15 * inch));
  const std::string wider = mill_ini + "[JOINT_2]\nMIN_LIMIT = -5\n";
  const Actuator same = actuators(read_machine(import_linuxcnc({{"mill.ini", wider}}), "m.toml"))[1];
  CHECK(same.min == doctest::Approx(0));
  CHECK(same.max == doctest::Approx(16 * inch));
  CHECK(message_of_ini(mill_ini + "[JOINT_2]\nMIN_LIMIT = 20\nMAX_LIMIT = 36\n") ==
        "m.ini:4:14: error: the joints 1, 2 of axis Y have no travel in common: the largest MIN_LIMIT is 20, "
        "the least "
        "MAX_LIMIT is 16; correct them");
  CHECK(message_of_ini(mill_ini + "[JOINT_2]\nTYPE = ANGULAR\n") ==
        "m.ini:21:8: error: the TYPE of joint 2, axis Y, is 'ANGULAR'; it must be LINEAR");
}

TEST_CASE("a machine without a name in the INI file is named by the file") {
  CHECK(read_machine(import_linuxcnc({{"shop/mill.ini", replaced(mill_ini, "knee mill", "")}}), "m.toml")
            .name == "mill");
}

TEST_CASE("bad HAL files are refused at their place") {
  CHECK(message_of_hal("loadrt trivkins\n") ==
        "arm.hal:1:1: error: no line sets a pin of genserkins or genhexkins; import the HAL "
        "file that does, or the INI file");
  CHECK(message_of_hal(replaced(serial_pins(), "setp genserkins.A-2 380\n", "")) ==
        "arm.hal:1:1: error: no line sets the pin genserkins.A-2; its default depends on the version of "
        "LinuxCNC. Add: setp "
        "genserkins.A-2 VALUE");
  CHECK(message_of_hal(serial_pins("setp genserkins.D-0 1\n")) ==
        "arm.hal:21:21: error: the pin genserkins.D-0 is set a second time; the first is arm.hal:5");
  CHECK(message_of_hal(serial_pins("setp genserkins.ALPA-0 1\n")) ==
        "arm.hal:21:24: error: unknown pin genserkins.ALPA-0; did you mean genserkins.ALPHA-0?");
  CHECK(message_of_hal(replaced(serial_pins(), "genserkins.A-2 380", "genserkins.A-2 nan")) ==
        "arm.hal:9:21: error: genserkins.A-2 is 'nan'; it must be a finite number");
  CHECK(message_of_hal(replaced(serial_pins(), "setp genserkins.A-2 380", "net length genserkins.A-2")) ==
        "arm.hal:9:12: error: the pin genserkins.A-2 is connected with a signal, so its value is not known; "
        "use setp");
  CHECK(message_of_hal(replaced(serial_pins(), "genserkins.A-2 380", "genserkins.A-2")) ==
        "arm.hal:9:6: error: setp genserkins.A-2 needs one value");
  CHECK(message_of_hal(serial_pins("setp genserkins.unrotate-3 0.5\n")) ==
        "arm.hal:21:28: error: genserkins.unrotate-3 is 0.5; it must be a whole number");
  CHECK(message_of_hal(replaced(hexapod_pins(), "setp genhexkins.base.3.y -570\n", "")) ==
        "arm.hal:1:1: error: no line sets the pin genhexkins.base.3.y; its default depends on the version of "
        "LinuxCNC. Add: setp "
        "genhexkins.base.3.y VALUE");
  CHECK(message_of_hal(hexapod_pins("setp genhexkins.screw-lead 5\n")) ==
        "arm.hal:37:28: error: the strut lengths depend on the orientation of the joints (screw-lead is not "
        "0); this is not "
        "imported");
}

TEST_CASE("bad INI files are refused at their place") {
  CHECK(message_of_ini(replaced(mill_ini, "LINEAR_UNITS = inch\n", "")) ==
        "m.ini:1:1: error: the file has no LINEAR_UNITS in [TRAJ]; the unit of its lengths is not known. "
        "Add: LINEAR_UNITS = mm");
  CHECK(message_of_ini(replaced(mill_ini, "= inch", "= cm")) ==
        "m.ini:7:16: error: LINEAR_UNITS is 'cm'; it must be mm or inch");
  CHECK(message_of_ini(replaced(mill_ini, "[TRAJ]\n", "[TRAJ]\nANGULAR_UNITS = grad\n")) ==
        "m.ini:7:17: error: ANGULAR_UNITS is 'grad'; only degree is imported");
  CHECK(message_of_ini(replaced(mill_ini, "KINEMATICS = trivkins coordinates=xyyza\n", "")) ==
        "m.ini:1:1: error: the file has no KINEMATICS in [KINS], so the kind of machine is not known");
  CHECK(message_of_ini(replaced(mill_ini, "trivkins", "pumakins")) ==
        "m.ini:4:14: error: the kinematics pumakins is not imported; allowed are genserkins, genhexkins and "
        "trivkins. An arm can "
        "be imported from its Denavit-Hartenberg parameters with `import dh`");
  CHECK(message_of_ini(replaced(mill_ini, "xyyza", "xyq")) ==
        "m.ini:4:14: error: coordinates are 'XYQ'; allowed are the letters X Y Z A B C U V W");
  CHECK(message_of_ini(replaced(mill_ini, "JOINTS = 5\n", "")) ==
        "m.ini:4:14: error: [KINS] must have JOINTS, the number of joints, from 1 to 9");
  CHECK(message_of_ini(replaced(mill_ini, "MAX_LIMIT = 16", "MAX_LIMIT = -16")) ==
        "m.ini:15:13: error: MAX_LIMIT of [JOINT_1] is not above its MIN_LIMIT");
  CHECK(message_of_ini(replaced(mill_ini, "MAX_LIMIT = 16", "MAX_LIMIT = far")) ==
        "m.ini:15:13: error: [JOINT_1] MAX_LIMIT is 'far'; it must be a finite number");
  CHECK(message_of_ini(replaced(mill_ini, "TYPE = LINEAR", "TYPE = ANGULAR")) ==
        "m.ini:9:8: error: the TYPE of joint 0, axis X, is 'ANGULAR'; it must be LINEAR");
  CHECK(message_of_ini("[KINS]\n#INCLUDE more.inc\n") ==
        "m.ini:2:1: error: #INCLUDE is not followed; put the lines of that file here");
  CHECK(message_of_ini("[KINS\n") == "m.ini:1:1: error: the name of the section has no ]");
}

}  // namespace counterflex::import_linuxcnc_test
