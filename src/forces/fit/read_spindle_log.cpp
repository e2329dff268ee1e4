#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "counterflex/files/csv_text.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/forces/spindle_fit.hpp"
#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

using csv::fail;

struct Channel {
  std::string_view name;
  SpindleChannel channel;
  double unit;
};
constexpr std::array<Channel, 3> channels = {{{"power_W", SpindleChannel::power, 1},
                                              {"power_kW", SpindleChannel::power, 1000},
                                              {"torque_Nm", SpindleChannel::torque, 1}}};

// A largest value that repeats in this many consecutive rows, and this many times longer than any other
// between the least and itself, is taken to be a bound. In a log of few values all values repeat.
constexpr std::size_t saturated_rows = 5, saturated_share = 3, least_values = 10;

/// The columns of key and value.
struct Columns {
  std::size_t key = 0, value = 0;
  double unit = 1;
};

class LogReader {
 public:
  LogReader(std::string_view text, const std::string& file) : text_(text) { log_.file = file; }

  SpindleLog read() {
    while (!text_.empty()) {
      const std::string_view line = csv::take_line(text_);
      ++row_;
      const std::string_view content = csv::trimmed(line);
      if (content.empty()) continue;
      if (content.front() == '#')
        read_comment(content);
      else if (!columns_)
        read_header(line);
      else
        read_row(line);
    }
    if (!columns_) fail(at(1), "no header row; it must have t_s or line, and power_W, power_kW or torque_Nm");
    if (log_.samples.empty()) fail(at(1), "no rows");
    if (log_.full_scale) *log_.full_scale *= columns_->unit;
    refuse_saturated();
    return std::move(log_);
  }

 private:
  Location at(int column) const { return {log_.file, row_, column}; }

  void read_comment(std::string_view content) {
    const std::size_t sign = content.find('=');
    if (sign == std::string_view::npos) return;
    const std::string_view key = csv::trimmed(content.substr(1, sign - 1));
    if (key != "rapid_mm_min" && key != "full_scale") return;
    const auto value = read_number(csv::trimmed(content.substr(sign + 1)));
    if (!value || !(*value > 0))
      fail(at(1), fmt::format("{} is '{}'; it must be a number greater than 0", key,
                              csv::trimmed(content.substr(sign + 1))));
    if (key == "full_scale")
      log_.full_scale = *value;
    else
      log_.rapid_m_s = *value * mm / 60;
  }

  void read_header(std::string_view line) {
    columns_.emplace();
    bool has_time = false, has_value = false;
    const std::vector<csv::Field> fields = csv::split(line);
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (fields[i].text == "line" || (fields[i].text == "t_s" && !log_.by_line)) {
        columns_->key = i;
        log_.by_line = fields[i].text == "line";
        has_time = true;
      }
      for (const Channel& channel : channels) {
        if (fields[i].text != channel.name) continue;
        if (has_value)
          fail({log_.file, row_, fields[i].column},
               "a second channel; the log must have one of power_W, power_kW and torque_Nm");
        columns_->value = i;
        columns_->unit = channel.unit;
        log_.channel = channel.channel;
        has_value = true;
      }
    }
    if (!has_time) fail(at(1), "no column t_s or line; rows need a time in s or a line of the program");
    if (!has_value) fail(at(1), "no column power_W, power_kW or torque_Nm");
  }

  double number(const std::vector<csv::Field>& fields, std::size_t i, std::string_view name) const {
    if (i >= fields.size()) fail(at(1), fmt::format("{} is missing", name));
    if (const auto value = read_number(fields[i].text)) return *value;
    fail({log_.file, row_, fields[i].column},
         fmt::format("{} is '{}'; it must be a finite number", name, fields[i].text));
  }

  void read_row(std::string_view line) {
    const std::vector<csv::Field> fields = csv::split(line);
    const std::string_view key_name = log_.by_line ? "line" : "t_s";
    const double key = number(fields, columns_->key, key_name);
    const double value = number(fields, columns_->value, "the channel") * columns_->unit;
    if (!log_.by_line && !log_.samples.empty() && !(key > log_.samples.back().key))
      fail({log_.file, row_, fields[columns_->key].column},
           fmt::format("t_s is {}; it must be greater than {}, that of the row before", key,
                       log_.samples.back().key));
    log_.samples.push_back({key, value, row_});
  }

  /// The longest runs of equal values: of the largest value, and of those between it and the least.
  void refuse_saturated() const {
    const auto& samples = log_.samples;
    const auto [least, most] = std::minmax_element(
        samples.begin(), samples.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
    const std::string_view what = "; limit the cut or the range, and log again";
    if (log_.full_scale) {
      for (const SpindleSample& sample : samples)
        if (sample.value >= *log_.full_scale)
          csv::fail({log_.file, sample.row, 1},
                    fmt::format("the channel is saturated: the value is {:.6g}, its full scale{}",
                                sample.value / columns_->unit, what));
      return;
    }
    std::vector<double> values;
    for (const SpindleSample& sample : samples) values.push_back(sample.value);
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    if (values.size() < least_values) return;
    std::size_t of_most = 0, of_others = 1, run = 0, row = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      run = i > 0 && samples[i].value == samples[i - 1].value ? run + 1 : 1;
      if (samples[i].value == most->value && run > of_most) of_most = run, row = i + 1 - run;
      if (samples[i].value != most->value && samples[i].value != least->value)
        of_others = std::max(of_others, run);
    }
    if (of_most >= saturated_rows && of_most >= saturated_share * of_others)
      csv::fail({log_.file, samples[row].row, 1},
                fmt::format("the channel is saturated: {} rows in a row have its largest value, {:.6g}{}; if "
                            "this is not a bound, state the real one in # full_scale",
                            of_most, most->value / columns_->unit, what));
  }

  std::string_view text_;
  SpindleLog log_;
  std::optional<Columns> columns_;
  int row_ = 0;
};

}  // namespace

SpindleLog read_spindle_log(std::string_view text, const std::string& file) {
  return LogReader(text, file).read();
}

}  // namespace counterflex
