/// The test piece: its program, and the rows of its sheet.
#include "counterflex/identify/coupon.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "counterflex/machine/create.hpp"
#include "counterflex/machine/read_machine.hpp"
#include "identify/campaigns.hpp"

using namespace counterflex;
using namespace counterflex::campaigns;

namespace {

CouponRequest request_for_mill() {
  CouponRequest request;
  request.least_mm = Vector3(-120, -80, -5);
  request.most_mm = Vector3(120, 80, 0);
  return request;
}

const Pose X_MW{from_rpy(Vector3(0, 0, 0.3)), Vector3(0.3, 0.2, -0.4)};

/// The number behind a letter in a line, or `otherwise`.
double word(const std::string& line, char letter, double otherwise) {
  const std::size_t at = line.find(letter);
  return at == std::string::npos ? otherwise : std::atof(line.c_str() + at + 1);
}

/// Places of all cuts as the text of the program has them, without forces; the commands of `machine` there.
std::vector<CouponPlace> places_of(const Coupon& coupon, const Machine& machine) {
  std::map<int, bool> is_circle;
  for (const CouponQuantity& quantity : coupon.quantities)
    for (const CouponCut& cut : quantity.cuts) is_circle[cut.line] = quantity.fit != CouponFit::mean;
  const Pose home = tip(prepare(machine).mechanism, prepare(machine).home);
  const auto place = [&](int line, const Vector3& p_mm) {
    const Vector3 p = X_MW * Vector3(p_mm * mm);
    return CouponPlace{line, p, 1, {shown_homes(machine) + (p - home.p)}};
  };
  std::vector<CouponPlace> places;
  Vector3 at = Vector3::Zero();
  int line = 0;
  for (std::string_view text = coupon.text; !text.empty();) {
    const std::size_t end = text.find('\n');
    const std::string block(text.substr(0, end));
    text.remove_prefix(end + 1);
    ++line;
    if (block[0] != 'G') continue;
    const Vector3 to(word(block, 'X', at.x()), word(block, 'Y', at.y()), word(block, 'Z', at.z()));
    if (const auto cut = is_circle.find(line); cut != is_circle.end())
      for (int k = 0; k < 8; ++k) {
        const double radius = -word(block, 'I', 0), angle = 2 * pi * k / 8;
        const Vector3 along =
            cut->second
                ? Vector3(to - Vector3(radius, 0, 0) + radius * Vector3(std::cos(angle), std::sin(angle), 0))
                : Vector3(at + (to - at) * k / 7.0);
        places.push_back(place(line, along));
      }
    at = to;
  }
  return places;
}

/// What a row shows if every place deviates by d(p), p in program coordinates (m).
template <typename Deviation>
double shown(const Measurement& row, const Deviation& d) {
  double value = 0;
  for (const FeaturePlace& place : row.places)
    value += place.weight.dot(X_MW.R * d(inverse(X_MW) * place.p_MT));
  return value;
}

Machine mill_for_coupon() {
  return read_machine(machine_file(MachineFacts{}), "mill.toml");
}

struct CutPiece {
  Machine machine = mill_for_coupon();
  Coupon coupon = make_coupon(request_for_mill());
  Measurements rows = coupon_rows(coupon, places_of(coupon, machine), X_MW);
};

/// The sheet with a measured value in a row.
std::string filled(std::string sheet, const std::string& row, const std::string& value) {
  const std::size_t at = sheet.find("\n" + row + ",");
  REQUIRE(at != std::string::npos);
  const std::size_t end = sheet.find('\n', at + 1);
  return sheet.insert(sheet.rfind(",,", end) + 1, value);
}

std::string error_of(const std::string& sheet, const Machine& machine) {
  try {
    Measurements all;
    read_measurements(sheet, "s.csv", machine, all);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a coupon's tool plunges where it has cut, and ramps by at most 0.1 mm in 1 mm") {
  struct Cut {
    Vector3 from, to;
  };
  for (const double diameter_mm : {6.0, 10.0}) {
    CouponRequest request = request_for_mill();
    request.diameter_mm = diameter_mm;
    std::vector<Cut> cuts;
    Vector3 at = Vector3(0, 0, 100);
    int line = 0;
    const auto is_cut = [&](const Vector3& p) {
      return p.z() >= request.most_mm.z() || std::any_of(cuts.begin(), cuts.end(), [&](const Cut& cut) {
               const Vector3 way = cut.to - cut.from;
               const double square = way.head<2>().squaredNorm();
               const double u =
                   square > 0 ? std::clamp((p - cut.from).head<2>().dot(way.head<2>()) / square, 0.0, 1.0)
                              : 1;
               const Vector3 nearest = cut.from + u * way;
               return (nearest - p).head<2>().norm() < 1e-3 && nearest.z() <= p.z() + 1e-3;
             });
    };
    const Coupon coupon = make_coupon(request);
    for (std::string_view text = coupon.text; !text.empty();) {
      const std::string block(text.substr(0, text.find('\n')));
      text.remove_prefix(block.size() + 1);
      ++line;
      if (!block.starts_with("G0 ") && !block.starts_with("G1 ") && !block.starts_with("G3 ")) continue;
      const Vector3 to(word(block, 'X', at.x()), word(block, 'Y', at.y()), word(block, 'Z', at.z()));
      const double radius = -word(block, 'I', 0);
      const double length = block.starts_with("G3") ? 2 * pi * radius : (to - at).head<2>().norm();
      if (block[1] != '0' && at.z() - to.z() > 0.1 * length + 1e-4 && !is_cut(to)) {
        CAPTURE(line);
        CAPTURE(block);
        FAIL_CHECK("a steep cut into metal");
      }
      if (block[1] == '1') cuts.push_back({at, to});
      at = to;
    }
  }
}

TEST_CASE("a shift of the tip moves the features of a coupon, and changes no size") {
  const CutPiece piece;
  const Vector3 shift(3e-6, -5e-6, 7e-6);
  for (std::size_t k = 0; k < piece.coupon.quantities.size(); ++k) {
    const CouponQuantity& quantity = piece.coupon.quantities[k];
    CAPTURE(quantity.feature);
    CAPTURE(quantity.name);
    double expected = 0;
    if (quantity.name.starts_with("x_")) expected = shift.x();
    if (quantity.name.starts_with("y_")) expected = shift.y();
    if (quantity.name == "z_mm") expected = shift.z();
    if (quantity.name == "position_45deg_mm") expected = (shift.x() + shift.y()) / std::sqrt(2.0);
    if (quantity.name == "position_135deg_mm") expected = (-shift.x() + shift.y()) / std::sqrt(2.0);
    CHECK(std::abs(shown(piece.rows.rows[k], [&](const Vector3&) { return shift; }) - expected) < 1e-12);
  }
}

TEST_CASE("a tip whose path is larger by a share makes places and paths larger by that share") {
  const CutPiece piece;
  const double share = 1e-4, R_mm = 5;
  for (std::size_t k = 0; k < piece.coupon.quantities.size(); ++k) {
    const CouponQuantity& quantity = piece.coupon.quantities[k];
    CAPTURE(quantity.feature);
    CAPTURE(quantity.name);
    // The path is a radius outside of a wall, inside of a circle.
    const double length_mm = quantity.nominal_mm - quantity.radius_share * R_mm;
    CHECK(shown(piece.rows.rows[k], [&](const Vector3& p) { return Vector3(share * p); }) ==
          doctest::Approx(share * length_mm * mm).epsilon(1e-4));
    CHECK(quantity.radius_share == (quantity.name.starts_with("width") ? -2
                                    : quantity.name == "diameter_mm"   ? 2
                                                                       : 0));
  }
}

TEST_CASE("both halves of a coupon have the same features, and the program has all of them") {
  const Coupon coupon = make_coupon(request_for_mill());
  const std::size_t half = coupon.quantities.size() / 2;
  REQUIRE(coupon.quantities.size() == 2 * half);
  CHECK(half == 22);
  for (std::size_t k = 0; k < half; ++k) {
    CHECK(coupon.quantities[k].name == coupon.quantities[half + k].name);
    CHECK_FALSE(coupon.quantities[k].is_corrected);
    CHECK(coupon.quantities[half + k].is_corrected);
    CHECK(coupon.quantities[k].cuts[0].line < coupon.first_corrected_line);
    CHECK(coupon.quantities[half + k].cuts[0].line > coupon.first_corrected_line);
  }
}

TEST_CASE("a box that is too small for the tool is refused with the size that it needs") {
  CouponRequest request = request_for_mill();
  request.diameter_mm = 12;
  CHECK_THROWS_WITH_AS(make_coupon(request),
                       "error: --box is 240 x 160 x 5 mm; a coupon for a tool of 12 mm needs at least 278.4 "
                       "x 168 x 1.2 mm: take "
                       "a larger box or a smaller tool",
                       InputError);
}

TEST_CASE("a box that is too deep for the tool is refused") {
  CouponRequest request = request_for_mill();
  request.least_mm.z() = -21;
  CHECK_THROWS_WITH_AS(
      make_coupon(request),
      "error: --box is 21 mm deep; a tool of 10 mm cuts a coupon of at most 20 mm: raise Z0 or "
      "take a larger tool",
      InputError);
}

TEST_CASE("a sheet that was written is read with the rows that have a value") {
  const CutPiece piece;
  const std::vector<CouponPrediction> predictions =
      predict_coupon(piece.machine, piece.coupon, piece.rows, 1);
  const std::string sheet = coupon_sheet(piece.machine, piece.coupon, piece.rows, predictions, 3e-6);
  CHECK(is_coupon_sheet(sheet));
  const CouponQuantity& first = piece.coupon.quantities[0];
  std::string with_values =
      filled(sheet, "hole 1,not corrected,x_centre_mm", std::to_string(first.nominal_mm + 0.012));
  with_values = filled(with_values, "tool,,diameter_mm", "9.99");
  const auto check = [&](const std::string& text) {
    Measurements read;
    read_measurements(text, "sheet.csv", piece.machine, read);
    REQUIRE(read.rows.size() == 2);
    CHECK(read.empty_rows == piece.rows.rows.size() - 2);
    CHECK(read.rows[0].value == doctest::Approx(12e-6).epsilon(1e-2));
    CHECK(read.rows[1].value == doctest::Approx(-10e-6).epsilon(1e-6));
    CHECK(read.rows[1].offset_share == 2);
    REQUIRE(read.rows[0].places.size() == piece.rows.rows[0].places.size());
    for (std::size_t i = 0; i < read.rows[0].places.size(); ++i) {
      CHECK((read.rows[0].states[i].shown - piece.rows.rows[0].states[i].shown).norm() < 1e-8);
      CHECK((read.rows[0].places[i].p_MT - piece.rows.rows[0].places[i].p_MT).norm() < 1e-8);
      CHECK((read.rows[0].places[i].weight - piece.rows.rows[0].places[i].weight).norm() < 1e-8);
    }
  };
  check(with_values);
  // As a spreadsheet with semicolons and decimal commas saves it.
  std::string other = with_values;
  for (char& c : other) c = c == ',' ? ';' : c == '.' ? ',' : c;
  check(other);
}

TEST_CASE("sizes alone show compliance, positions need as many values as the frame has freedoms") {
  CutPiece piece;
  Measurements sizes = piece.rows, places = piece.rows;
  sizes.rows.clear();
  places.rows.clear();
  for (std::size_t k = 0; k < piece.coupon.quantities.size() / 2; ++k) {
    const std::string& name = piece.coupon.quantities[k].name;
    if (name.starts_with("width")) sizes.rows.push_back(piece.rows.rows[k]);
    if (name.ends_with("position_mm")) places.rows.push_back(piece.rows.rows[k]);
  }
  // The wall of 150 N on both sides is 10 um wider than that of a machine of 30 N/um: it has 15 N/um.
  for (Measurement& row : sizes.rows) {
    for (std::size_t i = 0; i < row.states.size(); ++i)
      row.states[i].F.head<3>() = 150 * row.places[i].weight.normalized();
    row.value = 2 * 150 / 15e6;
  }
  sizes.rows.push_back(piece.rows.rows.back());  // the tool
  IdentifyOptions options;
  options.ladder = false;
  options.sets = {ParameterSet::compliance};
  const Identification found = identify(piece.machine, sizes, options);
  for (const IdentifiedParameter& parameter : found.parameters)
    if (parameter.name != "Z.compliance_m_per_N") {
      CAPTURE(parameter.name);
      CHECK(parameter.value == doctest::Approx(1 / 15e6).epsilon(0.01));
    }
  places.rows[0].at = {"s.csv", 9, 1};
  CHECK_THROWS_WITH_AS(identify(piece.machine, places, options),
                       "s.csv:9:1: error: session \"coupon\" has 2 measured numbers; its frames alone have 7 "
                       "freedoms: measure more states",
                       InputError);
}

TEST_CASE("a sheet has the directions of the actuators with lost motion") {
  Machine lost = mill_for_coupon();
  std::get<Actuator>(
      *std::find_if(lost.chains[0].elements.begin(), lost.chains[0].elements.end(),
                    [](const Element& element) { return std::holds_alternative<Actuator>(element); }))
      .reversal = 10e-6;
  CutPiece piece{lost};
  for (Measurement& row : piece.rows.rows)
    for (std::size_t i = 0; i < row.states.size(); ++i)
      row.states[i].directions.set(0, static_cast<int>(i % 3) - 1);
  const std::string sheet =
      filled(coupon_sheet(lost, piece.coupon, piece.rows,
                          std::vector<CouponPrediction>(piece.rows.rows.size()), 3e-6),
             "hole 1,not corrected,x_centre_mm", std::to_string(piece.coupon.quantities[0].nominal_mm));
  Measurements read;
  read_measurements(sheet, "s.csv", lost, read);
  REQUIRE(read.rows.size() == 1);
  REQUIRE(read.rows[0].states.size() == piece.rows.rows[0].states.size());
  for (std::size_t i = 0; i < read.rows[0].states.size(); ++i)
    CHECK(read.rows[0].states[i].directions == piece.rows.rows[0].states[i].directions);

  std::string wrong = sheet;
  const std::size_t at = wrong.find(",-1,");
  CHECK(error_of(wrong.replace(at, 4, ",2,"), lost).find("d1 is 2; the direction of an actuator is 1, -1") !=
        std::string::npos);
}

TEST_CASE("a sheet with wrong values is refused at the row") {
  const CutPiece piece;
  const std::string sheet = coupon_sheet(piece.machine, piece.coupon, piece.rows,
                                         std::vector<CouponPrediction>(piece.rows.rows.size()), 3e-6);
  CHECK(error_of(sheet, piece.machine) ==
        "s.csv: error: no row has a measured value; write them into the column measured_mm");
  const std::string row = "tool,,diameter_mm";
  CHECK(error_of(filled(sheet, row, "0.3937"), piece.machine) ==
        "s.csv:50:36: error: measured_mm is 0.3937, -9.61 mm from the nominal value 10; at most 5 mm is "
        "allowed: "
        "check the unit, the alignment and the row");
  CHECK(error_of(filled(sheet, row, "ten"), piece.machine) ==
        "s.csv:50:36: error: measured_mm is \"ten\"; it must be a number");
  const std::string tables = filled(sheet, row, "10.003");
  CHECK(error_of(tables.substr(0, tables.find("\nplace_of")), piece.machine) ==
        "s.csv:50:1: error: the sheet has no places of \"tool, diameter_mm\"; keep the second table that "
        "testcut "
        "wrote");
  const Machine robot = load_machine(COUNTERFLEX_SOURCE_DIR "/samples/robot-ur10/machine.toml");
  CHECK(error_of(tables, robot).find("the table has no column \"q1_deg\"") != std::string::npos);
  CHECK(error_of("kind,X_mm,Y_mm,Z_mm\ncmm_feature,0,0,0\n", piece.machine) ==
        "s.csv:2:1: error: rows of kind cmm_feature are those of a sheet that testcut wrote; pass the sheet "
        "as it "
        "is");
}
