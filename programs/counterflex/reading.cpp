#include "reading.hpp"

namespace counterflex::cli {

ProgramLook look_through(const Options& options, ProgramFile& file, const ReadOptions& read,
                         const Machine* machine) {
  const std::string name = shown_name(options.program);
  ProgramLook look;
  try {
    file.bytes.hash_along();
    ProgramReader reader(file.bytes, name, read);
    for (bool first = true; reader.next(); first = false) {
      add_window(look.program, reader.window());
      if (first) look.is_corrected = is_corrected(reader.window());
    }
  } catch (const InputError& error) {
    blame_dialect(error, options, machine, name);
  }
  file.file.sha256 = sha256(file.bytes);
  return look;
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

}  // namespace counterflex::cli
