#pragma once
/// A test piece: the program that cuts it, what is measured on it, and the sheet for the measured values.
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/identify/measurements.hpp"

namespace counterflex {

/// What a coupon is cut from, and with what. Lengths in mm, program coordinates.
struct CouponRequest {
  Vector3 least_mm = Vector3::Zero();  ///< z: of the deepest floor
  Vector3 most_mm = Vector3::Zero();   ///< z: of the top of the stock
  long tool = 1;
  double diameter_mm = 10;
  double feed_mm_min = 200, speed_rpm = 2000;
};

/// How a quantity follows from the deviations of the tip along its cuts.
enum class CouponFit {
  mean,      ///< sum of `share` times the mean along the cut in `direction`
  circle_x,  ///< of the circle of least squares: centre or diameter
  circle_y,
  circle_diameter
};

/// A move that cuts a measured surface.
struct CouponCut {
  int line = 0;                          ///< of the program
  Vector3 direction = Vector3::UnitX();  ///< unit vector, axes of the program
  double share = 1;
};

/// A row of the sheet.
struct CouponQuantity {
  std::string feature;        ///< "wall 1"
  bool is_corrected = false;  ///< in the half that is corrected
  std::string name;           ///< "x_position_mm"
  double nominal_mm = 0;
  CouponFit fit = CouponFit::mean;
  std::vector<CouponCut> cuts;
  double radius_share = 0;              ///< of a deviation of the tool's radius
  Vector3 centre_mm = Vector3::Zero();  ///< of a circle, program coordinates
};

struct Coupon {
  std::string text;  ///< of the program, none of it corrected: LinuxCNC, G54
  std::vector<CouponQuantity> quantities;
  int first_corrected_line = 0;  ///< from here on the program is to be corrected
  double diameter_mm = 0;        ///< of the tool
};

/// The line before the half that is corrected.
inline constexpr std::string_view corrected_half = "(HALF CORRECTED)";

/// Two equal halves of walls, steps, a circle, holes and a turned square, side by side in x. Throws
/// `InputError` (ErrorKind::usage) if the box is too small for the tool.
Coupon make_coupon(const CouponRequest& request);

/// A place of a cut: what was commanded there and what acts.
struct CouponPlace {
  int line = 0;                    ///< of the program
  Vector3 p_MT = Vector3::Zero();  ///< wanted tip, M (m), where the loaded part with its fixture has it
  double way = 0;                  ///< length of the cut that the place represents (m)
  CommandedState state;
};

/// The rows of all quantities, with value 0: nothing deviates. `X_MW`: program coordinates in M. Cuts without
/// a place are a programmer's error. The last row is the diameter of the tool.
Measurements coupon_rows(const Coupon& coupon, const std::vector<CouponPlace>& places, const Pose& X_MW);

/// What the machine file predicts for a row. SI.
struct CouponPrediction {
  double deviation = 0;  ///< from nominal, in the frame that fits the corrected half best
  double sigma = 0;      ///< of it, from the deviations of the parameters
};

/// By row of `rows`. Parameters without a deviation in the machine file have that with which `identify`
/// begins.
std::vector<CouponPrediction> predict_coupon(const Machine& machine, const Coupon& coupon,
                                             const Measurements& rows, int threads);

/// How sheets begin.
inline constexpr std::string_view sheet_mark = "# counterflex-sheet 1";

/// The sheet: a table of quantities to be filled in, and behind it a table of their places.
std::string coupon_sheet(const Machine& machine, const Coupon& coupon, const Measurements& rows,
                         const std::vector<CouponPrediction>& predictions, double sigma);

/// Whether a measurement file is a sheet: by the columns of its first table.
bool is_coupon_sheet(std::string_view csv);

/// Adds the rows of a sheet that have a measured value. Throws `InputError` (ErrorKind::machine_or_force).
void read_coupon_sheet(std::string_view csv, const std::string& file, const Machine& machine,
                       Measurements& all);

}  // namespace counterflex
