#include "run/reading.hpp"

#include <algorithm>
#include <utility>

#include "counterflex/compensation/windows.hpp"

namespace counterflex::cli {
namespace {

/// Whether the machine moves along all axes of any program: then unknown positions of all axes matter.
bool ignores_no_axis(const Machine& machine) {
  return machine.controlled.empty() || (controls(machine, Component::x) && controls(machine, Component::y) &&
                                        controls(machine, Component::z));
}

/// Logged positions are matched in space. This needs more than one pass.
bool has_logs(const ForceSource& source) {
  return std::any_of(source.rules.begin(), source.rules.end(), [](const ForceRule& rule) {
    const auto* profile = std::get_if<ForceProfile>(&rule.content);
    return profile != nullptr && profile->key == ForceKey::point;
  });
}

}  // namespace

ProgramScan scan_program(const Options& options, ProgramFile& file, const ReadOptions& read,
                         const std::function<void(const Program&)>& also) {
  const std::string name = shown_name(options.program);
  ProgramScan scan;
  try {
    file.bytes.hash_along();
    ProgramReader reader(file.bytes, name, read);
    bool begun = false;
    const auto first = [&](const Program& window) {
      add_window(scan.program, window);
      if (!std::exchange(begun, true)) scan.is_corrected = is_corrected(window);
    };
    for_each_window(
        reader, also ? options.threads : 1, first, also ? also : [](const Program&) {});
  } catch (const InputError&) {
    file.bytes.refuse_change();  // a file replaced while it was read has errors of its own
    throw;
  }
  if (file.data_lists.empty()) file.file.sha256 = sha256(file.bytes);
  file.bytes.rewind();
  return scan;
}

void settle_forces(const PathInput& input, ForceSource& source) {
  ForceCover cover(source);
  while (cover.needs_pass()) {
    ProgramReader reader(input.bytes, input.name, input.read);
    PathEnd end;
    while (reader.next()) {
      ignore_axes(reader.window(), input.ignored);
      const Toolpath path = build_toolpath(reader.window(), input.frames, end);
      cover.add(reader.window(), path);
      end = path.end;
    }
    cover.end_pass();
  }
}

template <typename Work>
void ForcePrescan::keep_error(const Work& work) {
  try {
    work();
  } catch (const InputError&) {
    unsettled_ = std::current_exception();
  }
}

ForcePrescan::ForcePrescan(const Options& options, const Machine& machine, ForceInput& input)
    : source_(input.source) {
  try {
    input = read_force_input(options);
  } catch (const InputError&) {
    unread_ = std::current_exception();
    return;
  }
  if (ignores_no_axis(machine) && !has_logs(source_)) keep_error([&] { cover_.emplace(source_); });
}

void ForcePrescan::add(const Program& window) {
  if (!cover_ || unsettled_ || !cover_->needs_pass()) return;
  keep_error([&] {
    const Toolpath path = build_toolpath(window, one_frame(window, {}), end_);
    cover_->add(window, path);
    end_ = path.end;
  });
}

void ForcePrescan::refuse_unread() const {
  if (unread_) std::rethrow_exception(unread_);
}

void ForcePrescan::settle(const PathInput& input) {
  if (unsettled_) std::rethrow_exception(unsettled_);
  if (!cover_) return settle_forces(input, source_);
  if (cover_->needs_pass()) cover_->end_pass();
}

}  // namespace counterflex::cli
