#include "work.hpp"

#include <fmt/format.h>

#include "counterflex/files/input_error.hpp"
#include "counterflex/geometry/units.hpp"

namespace counterflex::cli {
namespace {

constexpr const char* power_on_offset = "G54";

/// The one offset that acts in all moves; empty where none is selected.
std::string selected_offset(const Program& program) {
  for (const Move& move : program.moves)
    if (move.work_offset != program.moves.front().work_offset)
      throw InputError(
          Exit::program_text, {program.file, move.line, 1},
          fmt::format(
              "{} is selected after moves under {}; programs with more than one work offset are not read yet",
              move.work_offset,
              program.moves.front().work_offset.empty() ? "the offset that was active before"
                                                        : program.moves.front().work_offset));
  return program.moves.empty() ? std::string() : program.moves.front().work_offset;
}

std::string names(const Machine& machine) {
  std::string text;
  for (const auto& [name, offset] : machine.work) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// Where the unloaded machine's tip stands, relative to where it should, at the touched point.
Vector3 deviation_at(const Model& model, const Vector3& p_MT, const std::string& file,
                     const std::string& offset) {
  const auto fail = [&](Status status) {
    throw InputError(
        Exit::machine_or_force, {file},
        fmt::format(
            "[work.{}] was touched off at ({:.6g}, {:.6g}, {:.6g}) mm of the machine frame, which the "
            "machine does not reach: {}",
            offset, p_MT.x() / mm, p_MT.y() / mm, p_MT.z() / mm, to_string(status)));
  };
  const Pose X_MT{tip(model.mechanism, model.home).R, p_MT};
  const NominalResult nominal = follow(model, model.home, X_MT);
  if (nominal.status != Status::converged) fail(nominal.status);
  StaticsWork work(model.mechanism);
  const Equilibrium actual = solve_forward(model, nominal.configuration, Load{}, Stage{}, work);
  if (actual.status != Status::converged) fail(actual.status);
  return tip(model.mechanism, actual.configuration).p - tip(model.mechanism, nominal.configuration).p;
}

}  // namespace

WorkPlace place_work(const Machine& machine, const Model& model, const std::string& machine_file,
                     const Program& program) {
  if (machine.work.empty()) return {};
  WorkPlace place;
  place.name = selected_offset(program);
  if (place.name.empty()) {
    place.name = power_on_offset;
    place.assumption = "the program selects no work offset; G54, which controls start with, is assumed";
  }
  const auto found = machine.work.find(place.name);
  if (found == machine.work.end())
    throw InputError(
        Exit::machine_or_force, {machine_file},
        fmt::format("no [work.{}], which the program {}; the offsets are {} (--work gives others)",
                    place.name, place.assumption.empty() ? "selects" : "starts with, selecting none",
                    names(machine)));
  place.X_MW = found->second.X_MW;
  if (const auto& touched = found->second.datum.touched_at)
    place.datum_shift = deviation_at(model, place.X_MW * *touched, machine_file, place.name);
  return place;
}

Pose wanted_frame(const WorkPlace& work) {
  return {work.X_MW.R, work.X_MW.p + work.datum_shift};
}

}  // namespace counterflex::cli
