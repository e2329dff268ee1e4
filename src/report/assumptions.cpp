#include "assumptions.hpp"

#include <fmt/core.h>

#include "counterflex/files/numbers.hpp"
#include "counterflex/geometry/units.hpp"

namespace counterflex {

namespace {

std::string three(const Vector3& v, int decimals) {
  return fmt::format("({}, {}, {})", format_fixed(v.x(), decimals), format_fixed(v.y(), decimals),
                     format_fixed(v.z(), decimals));
}

std::string place(const Pose& X) {
  std::string text = three(X.p / mm, 4) + " mm in the machine frame";
  const Vector3 rpy = to_rpy(X.R) / deg;
  if (rpy.cwiseAbs().maxCoeff() > 5e-5)
    text += fmt::format(", turned by roll, pitch, yaw {} deg", three(rpy, 4));
  return text;
}

}  // namespace

std::string work_in_words(const Machine& machine, const Job& job, const std::string& work_offset) {
  if (!work_offset.empty())
    return fmt::format("{} puts the program's origin at {}.", work_offset, place(job.X_MW));
  const std::string reason =
      machine.work.empty() ? "the machine file has no work offsets" : "no work offset is in use";
  return fmt::format("Program coordinates were taken as machine coordinates: {}.", reason);
}

std::string datum_in_words(const Machine& machine, const Job& job, const std::string& work_offset) {
  const auto offset = machine.work.find(work_offset);
  if (offset == machine.work.end() || !offset->second.datum.touched_at)
    return "The work frame was taken to be truly there, not found by touching the part off with this "
           "machine.";
  return fmt::format(
      "The part was touched off with this machine at {} mm in program coordinates: the machine's unloaded "
      "deviation "
      "there, {} mm in the machine frame, is part of the work frame, and corrections are relative to it.",
      three(*offset->second.datum.touched_at / mm, 4), three(job.datum_shift / mm, 4));
}

}  // namespace counterflex
