#pragma once
/// Faults of a writer, made in the text of a corrected program by rules and a seed.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "compensation/robot/written_programs.hpp"

namespace counterflex::test {

struct Fault {
  std::string what, text;
};

/// The numbers of a target in a text: three of the position, then those of the orientation.
struct TextTarget {
  std::vector<double> values;
  std::vector<Span> spans;
};

inline std::vector<TextTarget> targets_in(const std::string& text, const WrittenProgram& program) {
  const std::regex pattern(program.target);
  std::vector<TextTarget> targets;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) {
    TextTarget& target = targets.emplace_back();
    for (std::size_t i = 1; i < at->size(); ++i) {
      const auto begin = static_cast<std::size_t>(at->position(i));
      target.values.push_back(std::stod((*at)[i]));
      target.spans.push_back({begin, begin + static_cast<std::size_t>(at->length(i))});
    }
  }
  return targets;
}

/// `text` with other values of a target, in the decimals of the text.
inline std::string with_values(const std::string& text, const TextTarget& target,
                               const std::vector<double>& values) {
  std::string changed = text;
  for (std::size_t i = values.size(); i-- > 0;) {
    if (values[i] == target.values[i]) continue;
    const Span span = target.spans[i];
    const std::string old = text.substr(span.begin, span.end - span.begin);
    const std::size_t point = old.find('.');
    const std::size_t decimals = std::max<std::size_t>(3, point < old.size() ? old.size() - point - 1 : 0);
    changed.replace(span.begin, span.end - span.begin, fmt::format("{:.{}f}", values[i], decimals));
  }
  return changed;
}

/// Seeded faults in the numbers of targets.
class NumberFaults {
 public:
  NumberFaults(const WrittenProgram& program, const std::string& written, unsigned seed)
      : program_(program),
        written_(written),
        random_(seed),
        originals_(targets_in(program.text, program)),
        targets_(targets_in(written, program)) {}

  /// `each` faults of each rule that the language can have.
  std::vector<Fault> make(int each) {
    const auto last = targets_.front().values.size() - 1;
    for (int k = 0; k < each; ++k) {
      add("X and Y exchanged", [](Values& v, const Values&) { std::swap(v[0], v[1]); });
      add("Y and Z exchanged", [](Values& v, const Values&) { std::swap(v[1], v[2]); });
      add("first and last number of the orientation exchanged",
          [=](Values& v, const Values&) { std::swap(v[3], v[last]); });
      add("numbers of the orientation in rotated order",
          [](Values& v, const Values&) { std::rotate(v.begin() + 3, v.begin() + 4, v.end()); });
      add("old position left", [](Values& v, const Values& old) { std::copy_n(old.begin(), 3, v.begin()); });
      add("old Z left", [](Values& v, const Values& old) { v[2] = old[2]; });
      add("old orientation left",
          [](Values& v, const Values& old) { std::copy(old.begin() + 3, old.end(), v.begin() + 3); });
      add("correction with the other sign", [](Values& v, const Values& old) {
        for (std::size_t i = 0; i < v.size(); ++i) v[i] = 2 * old[i] - v[i];
      });
      add("correction applied twice", [](Values& v, const Values& old) {
        for (std::size_t i = 0; i < 3; ++i) v[i] = 2 * v[i] - old[i];
      });
      add("a sign is lost", [&](Values& v, const Values&) {
        double& value = v[3 + random_() % (v.size() - 3)];
        value = -value;
      });
      add("metres for millimetres, or the reverse", [&](Values& v, const Values&) {
        for (std::size_t i = 0; i < 3; ++i) v[i] *= program_.mm_of_length == 1 ? 1e-3 : 1e3;
      });
      add("inches for millimetres", [](Values& v, const Values&) {
        for (std::size_t i = 0; i < 3; ++i) v[i] /= 25.4;
      });
      if (has_angles())
        add("degrees for radians, or the reverse", [&](Values& v, const Values&) {
          for (std::size_t i = 3; i < v.size(); ++i) v[i] *= program_.in_radians ? 1 / deg : deg;
        });
      // An inserted target that moves along the path is no fault.
      add("a digit of the position changed", [&](Values& v, const Values&) {
        if (is_of_original(targets_[current_])) v[random_() % 3] += digit(program_.mm_of_length);
      });
      add("a digit of the orientation changed", [&](Values& v, const Values&) {
        v[3 + random_() % (v.size() - 3)] += digit(has_angles() && !program_.in_radians ? 0.1 : 10);
      });
      add("numbers of the next target",
          [&](Values& v, const Values&) { v = targets_[(current_ + 1) % targets_.size()].values; });
      exchange();
    }
    return std::move(faults_);
  }

 private:
  using Values = std::vector<double>;

  /// Of a quaternion or an axis its direction counts.
  static void normalise(Values& v) {
    double squares = 0;
    for (std::size_t i = 3; i < v.size(); ++i) squares += v[i] * v[i];
    for (std::size_t i = 3; i < v.size(); ++i) v[i] /= std::sqrt(squares);
  }

  bool has_angles() const { return !program_.is_quaternion && program_.dialect != "apt"; }

  /// A change of a digit of at least a hundredth of a unit: of mm, or 0.05 deg if `unit` is 10.
  double digit(double unit) {
    constexpr std::array places{0.01, 0.1, 1.0};
    const double sign = random_() % 2 == 0 ? 1 : -1;
    return sign * places[random_() % places.size()] * static_cast<double>(1 + random_() % 9) / unit;
  }

  /// A difference that is above every tolerance, with room: 0.01 mm, 0.05 degrees.
  bool differs(Values a, Values b) const {
    if (!has_angles()) normalise(a), normalise(b);
    const double least_turn = has_angles() && !program_.in_radians ? 0.06 : 0.06 * deg;
    double shift = 0, turn = 0;
    for (std::size_t i = 0; i < a.size(); ++i) (i < 3 ? shift : turn) += std::abs(a[i] - b[i]);
    return shift * program_.mm_of_length > 0.01 || turn > least_turn;
  }

  const TextTarget& original_of(const TextTarget& target) const {
    const auto off = [&](const TextTarget& other) {
      double sum = 0;
      for (std::size_t i = 0; i < target.values.size(); ++i)
        sum += std::abs(target.values[i] - other.values[i]) * (i < 3 ? program_.mm_of_length : 0.01);
      return sum;
    };
    return *std::min_element(originals_.begin(), originals_.end(),
                             [&](const TextTarget& a, const TextTarget& b) { return off(a) < off(b); });
  }

  /// Whether it is the corrected form of a target, not an inserted one.
  bool is_of_original(const TextTarget& target) const {
    double off = 0;
    const TextTarget& original = original_of(target);
    for (std::size_t i = 0; i < 3; ++i)
      off = std::max(off, std::abs(target.values[i] - original.values[i]) * program_.mm_of_length);
    return off < 5;
  }

  /// The rule at the first target, from a random one on, where it makes a difference.
  void add(const std::string& what, const std::function<void(Values&, const Values&)>& rule) {
    const std::size_t first = random_() % targets_.size();
    for (std::size_t k = 0; k < targets_.size(); ++k) {
      current_ = (first + k) % targets_.size();
      const TextTarget& target = targets_[current_];
      Values values = target.values;
      rule(values, original_of(target).values);
      if (!differs(values, target.values)) continue;
      const std::string text = with_values(written_, target, values);
      return faults_.push_back({fmt::format("{}, target {}", what, current_), text});
    }
  }

  /// Two targets change their places.
  void exchange() {
    const std::size_t a = random_() % (targets_.size() - 1), b = a + 1;
    if (!differs(targets_[a].values, targets_[b].values)) return;
    const std::string text = with_values(written_, targets_[b], targets_[a].values);
    faults_.push_back({fmt::format("targets {} and {} exchanged", a, b),
                       with_values(text, targets_[a], targets_[b].values)});
  }

  const WrittenProgram& program_;
  const std::string& written_;
  std::mt19937 random_;
  const std::vector<TextTarget> originals_, targets_;
  std::size_t current_ = 0;
  std::vector<Fault> faults_;
};

/// A fault in a statement: one of the places of `pattern` becomes `by`.
struct StatementFault {
  std::string what, pattern, by;
};

/// Each of `faults` at one place, which `seed` selects.
inline std::vector<Fault> statement_faults(const std::string& written,
                                           const std::vector<StatementFault>& faults, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Fault> made;
  for (const StatementFault& fault : faults) {
    const std::regex pattern(fault.pattern);
    std::vector<std::smatch> places{std::sregex_iterator(written.begin(), written.end(), pattern),
                                    std::sregex_iterator()};
    CAPTURE(fault.what);
    REQUIRE(!places.empty());
    const std::smatch& place = places[random() % places.size()];
    made.push_back({fmt::format("{}, at byte {}", fault.what, place.position()),
                    place.prefix().str() + place.format(fault.by) + place.suffix().str()});
  }
  return made;
}

}  // namespace counterflex::test
