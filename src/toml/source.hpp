#pragma once
/// The text of a TOML file, and the places of its nodes and keys.
#include <toml++/toml.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/files/input_error.hpp"

namespace counterflex::toml_file {

/// Converts regions of toml++ (columns in code points) to locations (columns in bytes), and throws errors
/// there. Keeps a view of `text`, which must outlive it.
class Source {
 public:
  Source(std::string_view text, std::string file);

  /// The document. Throws `InputError` at the place of a syntax error.
  toml::table parse() const;

  const std::string& file() const { return file_; }
  Location at(const toml::source_region& region) const;
  [[noreturn]] void fail(const toml::node& node, const std::string& message) const;
  [[noreturn]] void fail(const toml::key& key, const std::string& message) const;
  [[noreturn]] void fail_at_start(const std::string& message) const;

 private:
  [[noreturn]] void fail(const toml::source_region& region, const std::string& message) const;

  std::string_view text_;
  std::string file_;
  std::vector<std::size_t> line_starts_;
};

/// Whether `a` is before `b` in the file.
bool before(const toml::source_region& a, const toml::source_region& b);

/// The key `name` of `table`, which must exist.
const toml::key& key_of(const toml::table& table, std::string_view name);

}  // namespace counterflex::toml_file
