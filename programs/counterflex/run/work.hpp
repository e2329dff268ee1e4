#pragma once
/// Places a program in the machine frame.
#include <optional>
#include <string>
#include <vector>

#include "counterflex/compensation/loads_along.hpp"
#include "counterflex/program/overview.hpp"
#include "counterflex/statics/equilibrium.hpp"
#include "counterflex/toolpath/toolpath.hpp"

namespace counterflex::cli {

struct WorkPlace {
  /// By index into Program::frames; without names if the machine has no table of offsets.
  std::vector<WorkFrame> frames;
  /// For warnings: moves before an offset is selected, offsets without a pose, poses that differ.
  std::vector<Remark> assumptions;
};

/// Whether no work offset is needed: the program gives the pose of its base, or a robot program selects
/// none.
bool is_placed_by_program(const Overview& program, const ProgramFrame& frame);

/// The true poses of the offsets used by moves of `program`; the default is G54. A datum that was touched off
/// is at the tip of the unloaded machine without its thermal shift. Throws `InputError`
/// (ErrorKind::machine_or_force) if the table lacks an offset, if the machine does not reach the touched
/// point, or if the program gives an offset that was touched off another pose than the table.
WorkPlace place_work(const Machine& machine, const Model& model, const std::string& machine_file,
                     const Overview& program);

/// The same without a machine, from the texts of --work. Without texts all offsets are the machine frame.
/// Throws `InputError` (ErrorKind::usage) for wrong texts, or if an offset in use is missing.
WorkPlace place_work(const std::vector<std::string>& given, const Overview& program);

/// The pose of `frame` of a robot program, as the control knows it. Empty if its work offset is not in the
/// machine file, or was touched off.
std::optional<Pose> known_frame(const Machine& machine, const ProgramFrame& frame);

/// The pose of the work offset of a frame that is at `frame`, as the control has it.
Pose pose_of_offset(const WorkFrame& frame, const ProgramFrame& in_program);

/// The name of the offset that a program selects, or that of the default of the control; empty: a robot
/// program selects none.
std::string offset_name(const Overview& program, const ProgramFrame& frame);

/// Computes the common shift of the frames in use without a datum. `places` are those of the program.
void add_common_shifts(const Machine& machine, const Model& model, const StartTables& starts,
                       const PathPlaces& places, const Overview& program, int threads,
                       std::vector<WorkFrame>& frames);

}  // namespace counterflex::cli
