// Programs in parts, each compensated by a run of its own: merged, they are what one run makes of the whole.
#include "counterflex/compensation/recorded_windows.hpp"

#include <doctest/doctest.h>
#include <sys/resource.h>

#include "compensation/busy_program.hpp"
#include "compensation/parts.hpp"
#include "counterflex/files/bytes.hpp"
#include "record_file.hpp"
#include "window_record.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

WindowRun whole_run(const Split& split) {
  return take_over(split, {}).run;
}

/// Cuts of 1 mm to and fro under a force, `wrong` in place of the one numbered `at`.
Split raster(int count, int at = 0, const std::string& wrong = "") {
  std::string text = "G21 G90 G17\nG0 X0 Y0 Z0\nG1 F600\n";
  for (int k = 1; k <= count; ++k)
    text += k == at ? wrong + "\n" : fmt::format("X{} Y{}\n", k % 40, 0.5 * (k % 3));
  return {
      {.machine = load_machine(small_mill), .text = text, .force = constant_force({40, -25, 15, 0, 0, 0})}};
}

Split busy() {
  Split split{on_mill(busy_program())};
  split.order.force = constant_force({40, -25, 15, 0, 0, 0});
  return split;
}

/// A copy of a file of records, each of them as `change` leaves it.
std::string changed(const std::string& file, const std::function<void(WindowRecord&)>& change) {
  RecordWriter writer(file + ".changed", one_run);
  RecordReader reader(file, one_run);
  while (const auto bytes = reader.next()) {
    WindowRecord record = *window_record_of(*bytes);
    change(record);
    writer.add(to_bytes(record));
  }
  writer.finish().publish();
  return file + ".changed";
}

std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    CHECK(error.exit() == Exit::machine_or_force);
    return error.what();
  }
  return "none";
}

long peak_memory_kb() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

}  // namespace

TEST_CASE("a program compensated in parts is the same program, to the last bit of every waypoint" * doctest::test_suite("long")) {
  for (const bool attribution : {false, true}) {
    Split split = raster(400);
    split.attribution = attribution;
    const WindowRun whole = whole_run(split);
    CHECK(whole.windows > 20);
    for (const std::size_t parts : {1, 2, 3, 7})
      for (const int threads : {1, 3}) {
        CAPTURE(parts);
        CAPTURE(threads);
        const Folder folder;
        const Taken taken = take_over(split, record(split, parts, folder, threads), threads);
        check_same_run(taken.run, whole);
        CHECK(taken.compensated == 0);
        CHECK(taken.taken == whole.windows);
      }
  }
}

TEST_CASE("parts begin near enough to what a whole run has come to in a program where everything happens") {
  const Split split = busy();
  const WindowRun whole = whole_run(split);
  CHECK_FALSE(whole.failure);
  for (const std::size_t parts : {2, 3, 7}) {
    CAPTURE(parts);
    const Folder folder;
    const Taken taken = take_over(split, record(split, parts, folder));
    check_same_run(taken.run, whole);
    CHECK(taken.compensated <= parts);
    CHECK(taken.taken >= whole.windows / 2);
  }
}

TEST_CASE("parts of machines that change tools, and of parallel ones in lanes, are those of the whole") {
  Split split = raster(700);
  split.order.machine = load_machine(orthoglide_b);
  split.order.tolerance = 20e-6;
  split.order.in_lanes = true;
  split.least_moves = 100;
  const WindowRun whole = whole_run(split);
  CHECK_FALSE(whole.failure);
  const Folder folder;
  const Taken taken = take_over(split, record(split, 3, folder));
  check_same_run(taken.run, whole);
  CHECK(taken.compensated == 0);
}

TEST_CASE("what is recorded does not depend on threads, and its windows lie in its part") {
  const Split split = raster(400);
  const Folder folder;
  const auto one = record(split, 3, folder, 1), three = record(split, 3, folder, 3);
  std::size_t next = 0;
  for (std::size_t p = 0; p < one.size(); ++p) {
    CHECK(read_file(one[p]) == read_file(three[p]));
    RecordReader reader(one[p], one_run);
    for (; const auto bytes = reader.next(); ++next) CHECK(window_record_of(*bytes)->index == next);
  }
  CHECK(next == whole_run(split).windows);
}

TEST_CASE("windows without a record are compensated, in any order of files") {
  const Split split = raster(400);
  const WindowRun whole = whole_run(split);
  const Folder folder;
  const auto files = record(split, 4, folder);
  for (const auto& some : {std::vector<std::string>{files[2]}, {files[3], files[0]}, {files[1], files[1]}}) {
    for (const int threads : {1, 3}) {
      const Taken taken = take_over(split, some, threads);
      check_same_run(taken.run, whole);
      CHECK(taken.compensated > 4);
      CHECK(taken.taken > 4);
      CHECK(taken.taken + taken.compensated == whole.windows);
    }
  }
}

TEST_CASE("records that answer for another state are not taken over") {
  const Split split = raster(300);
  const WindowRun whole = whole_run(split);
  const Folder folder;
  const std::string file = record(split, 1, folder)[0];
  const std::vector<std::function<void(WindowRecord&)>> changes{
      [](WindowRecord& r) { r.entry.emitter.correction.x() += 1e-12; },
      [](WindowRecord& r) { r.entry.emitter.held[2] = 0.001; },
      [](WindowRecord& r) { r.entry.text.held[1].reset(); },
      [](WindowRecord& r) { r.entry.text.restate_motion = 1; },
      [](WindowRecord& r) { r.entry.command = Vector3(1, 2, 3); },
      [](WindowRecord& r) { r.entry.emitter.holds[0] = !r.entry.emitter.holds[0]; },
      [](WindowRecord& r) { r.start[0] = r.start[0] == 'a' ? 'b' : 'a'; },
      [](WindowRecord& r) { r.commands[5] = r.commands[5] == 'a' ? 'b' : 'a'; },
      [](WindowRecord& r) { ++r.bytes; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    CAPTURE(i);
    const std::string every_third = changed(file, [&](WindowRecord& r) {
      if (r.index % 3 == 1) changes[i](r);
    });
    for (const int threads : {1, 3}) {
      const Taken taken = take_over(split, {every_third}, threads);
      check_same_run(taken.run, whole);
      CHECK(taken.compensated == (whole.windows + 1) / 3);
    }
  }
}

TEST_CASE("the first window that fails ends the records, and is named by who takes them over") {
  for (const char* wrong : {"X99999", "X1 F", "X1 X2"}) {
    CAPTURE(wrong);
    const Split split = raster(300, 150, wrong);
    const auto failure_of = [&](const std::vector<std::string>& files, WindowRun& run) -> std::string {
      try {
        Taken taken = take_over(split, files);
        run = taken.run;
        return fmt::format("{}: {}", run.failure->line, run.failure->what);
      } catch (const InputError& error) {
        return error.what();
      }
    };
    WindowRun whole, merged;
    const std::string expected = failure_of({}, whole);
    CHECK(expected.find("153") != std::string::npos);
    const Folder folder;
    CHECK(failure_of(record(split, 3, folder), merged) == expected);
    check_same_run(merged, whole);
  }
}

TEST_CASE("a file that cannot be written ends a part, and leaves nothing") {
  const Folder folder;
  const Split split = raster(50);
  WindowShop shop(split.order, split.least_moves);
  WindowRun heard;
  CHECK_THROWS_AS(record_windows(*shop.windows, shop.options, TextReader(shop.reader), false, {{0, 100}},
                                 one_run, folder.file("none/part"), events_for(heard)),
                  InputError);
  CHECK(folder.count() == 0);
}

TEST_CASE(
    "a part in which no window begins has no records, and a program of one window is all in the first") {
  const Split split = raster(30);
  Split klartext = split;
  klartext.order.text = "BEGIN PGM A MM\nL X+0 Y+0 Z+0 R0 FMAX\nL X+10 F500\nL Y+5\nEND PGM A MM\n";
  klartext.order.read.dialect = "heidenhain";
  for (const Split& one : {split, klartext}) {
    const Folder folder;
    const auto files = record(one, 9, folder);
    const Taken taken = take_over(one, files);
    check_same_run(taken.run, whole_run(one));
    CHECK(taken.compensated == 0);
    CHECK_FALSE(RecordReader(files[1], one_run).next());
  }
}

TEST_CASE("a damaged file of records is refused by name: cut off anywhere, or with a wrong bit") {
  const Split split = raster(30);
  const Folder folder;
  const std::string bytes = read_file(record(split, 1, folder)[0]), file = folder.file("damaged");
  const auto refused = [&](const std::string& damaged) {
    write_file(file, damaged);
    return error_of([&] { RecordedWindows({file}, one_run); }).starts_with(file + ": error: ");
  };
  CHECK_FALSE(refused(bytes));
  std::size_t passed = 0;
  for (std::size_t length = 0; length < bytes.size(); length += length < 300 ? 1 : 97)
    passed += !refused(bytes.substr(0, length));
  for (std::size_t i = 0; i < bytes.size(); i += i < 300 ? 1 : 101) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << i % 8));
    passed += !refused(damaged);
  }
  CHECK(passed == 0);
  CHECK_FALSE(refused(bytes));
}

TEST_CASE("lengths and counts of gigabytes are refused, and no memory is taken for them") {
  const Folder folder;
  const std::string file = record(raster(30), 1, folder)[0], crafted = folder.file("crafted");
  const std::string whole = read_file(file), bytes = *RecordReader(file, one_run).next();
  const std::size_t begin = whole.find(bytes) - sizeof(std::size_t);
  const long before = peak_memory_kb();
  for (const std::size_t claim : {std::size_t{1} << 31, std::size_t{1} << 40, ~std::size_t{0} / 64, ~std::size_t{0}}) {
    CAPTURE(claim);
    std::string raw;
    put(claim, raw);
    std::string content = whole.substr(0, whole.size() - 64);
    content.replace(begin, raw.size(), raw);
    Sha256 hash;
    hash.add(content);
    write_file(crafted, content + hash.digits());
    CHECK(error_of([&] { RecordedWindows({crafted}, one_run); }) ==
          crafted + ": error: the recorded part of a program is damaged; compensate the part again");
    for (std::size_t i = 0; i + raw.size() <= bytes.size(); ++i) {
      std::string damaged = bytes;
      damaged.replace(i, raw.size(), raw);
      (void)window_record_of(damaged);
    }
  }
  CHECK(peak_memory_kb() - before < 64 * 1024);
}

TEST_CASE("records of another run are refused by name") {
  const Folder folder;
  const std::string file = record(raster(30), 1, folder)[0];
  const std::string error = error_of([&] { RecordedWindows({file}, "version 2"); });
  CHECK(error == file + ": error: was recorded in another run, with other files or options");
}

TEST_CASE("no bytes make a record read beyond their end") {
  const Folder folder;
  RecordReader reader(record(raster(30), 1, folder)[0], one_run);
  const std::string bytes = *reader.next();
  REQUIRE(window_record_of(bytes));
  std::size_t read = 0;
  for (std::size_t length = 0; length < bytes.size(); ++length)
    read += window_record_of(std::string_view(bytes).substr(0, length)).has_value();
  CHECK(read == 0);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(~damaged[i]);
    (void)window_record_of(damaged);
  }
}
