#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tether/base/error.h>
#include <tether/base/result.h>
#include <tether/base/time.h>

/// Reader of the TOML files that users write: a Document is parsed, and its Tables are read key by
/// key. Each mistake becomes an Error about the key, with file and line; its message says what was
/// found and what is allowed.
namespace tether::toml {

/// A value of the file, of the TOML library's type.
struct Node;

/// The values that a number may have.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;  ///< min itself is not allowed
  bool below_max = false;  ///< max itself is not allowed
  bool with_inf = false;   ///< +inf is allowed as well, whatever max is

  bool contains(double value) const;
  /// "at least 0 and at most 5", "greater than 0 and less than 180", "finite".
  std::string text() const;
};

/// The keys that a table may have.
using Keys = std::initializer_list<std::string_view>;

/// One table of a TOML file. Every reading function checks the value and throws Error(kBadFile) at
/// the line of the key, of a wrong element, or of the table's header for a missing key. A view: the
/// document must outlive it. With `allowed`, the table may have no other keys.
class Table {
 public:
  bool has(std::string_view key) const;
  std::vector<std::string> keys() const;
  /// "[uav.sensors.camera]", or "the file".
  std::string title() const;
  /// Throws at the first key that is not one of `allowed`.
  void require_keys_in(std::span<const std::string_view> allowed) const;

  // Required keys.
  std::string text(std::string_view key) const;
  /// May be empty and have any characters.
  std::string any_text(std::string_view key) const;
  /// Letters, digits, '_', '-' and '.', 1 to 64 of them, not starting with '.'.
  std::string identifier(std::string_view key) const;
  double number(std::string_view key, const Range& range) const;
  std::vector<std::string> texts(std::string_view key) const;
  std::vector<double> numbers(std::string_view key, std::size_t count, const Range& range) const;
  /// At least one.
  std::vector<double> numbers(std::string_view key, const Range& range) const;
  std::int64_t integer(std::string_view key, std::int64_t min, std::int64_t max) const;
  bool boolean(std::string_view key) const;
  std::vector<std::int64_t> integers(std::string_view key, std::int64_t min) const;
  /// Strings, numbers and booleans as on a command line; at least one.
  std::vector<std::string> scalars_as_texts(std::string_view key) const;
  /// A time span; the unit comes from the key's suffix (_s, _ms).
  Duration duration(std::string_view key, const Range& range) const;
  /// An existing regular file, relative to the folder of this file; absolute.
  std::filesystem::path existing_file(std::string_view key) const;
  /// Index into `choices`.
  std::size_t choice(std::string_view key, std::span<const std::string_view> choices) const;
  Table table(std::string_view key, Keys allowed) const;
  Table table(std::string_view key, std::span<const std::string_view> allowed) const;
  Table table(std::string_view key) const;
  /// At least one.
  std::vector<Table> tables(std::string_view key, Keys allowed) const;
  std::vector<Table> tables(std::string_view key, std::span<const std::string_view> allowed) const;
  std::vector<Table> tables(std::string_view key) const;

  // Keys that may be missing.
  std::string text_or(std::string_view key, std::string_view fallback) const;
  double number_or(std::string_view key, const Range& range, double fallback) const;
  std::optional<double> number_if(std::string_view key, const Range& range) const;
  std::int64_t integer_or(std::string_view key, std::int64_t min, std::int64_t max,
                          std::int64_t fallback) const;
  Duration duration_or(std::string_view key, const Range& range, Duration fallback) const;
  bool boolean_or(std::string_view key, bool fallback) const;
  std::vector<std::string> texts_or_none(std::string_view key) const;
  std::vector<Table> tables_or_none(std::string_view key, Keys allowed) const;

  /// A string, number or boolean as on a command line.
  std::string scalar_as_text(std::string_view key) const;
  bool is_table(std::string_view key) const;
  bool is_text(std::string_view key) const;

  FileLocation where() const;
  FileLocation where(std::string_view key) const;
  /// Throws at the key: "'key' of [table] " + problem.
  [[noreturn]] void fail(std::string_view key, const std::string& problem) const;
  /// Throws at the table's header: "[table] " + problem.
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  friend class Document;

  /// `path`: its name in messages ("uav.sensors.camera"; empty for the top of the file).
  Table(const Node& table, std::string path, std::string file);
  const Node& required(std::string_view key) const;
  [[noreturn]] void fail_at(const FileLocation& place, std::string_view key,
                            const std::string& problem) const;
  [[noreturn]] void fail_at(const Node& node, std::string_view key,
                            const std::string& problem) const;
  [[noreturn]] void fail_type(std::string_view key, const Node& found,
                              std::string_view expected) const;
  std::vector<const Node*> elements(std::string_view key, std::string_view expected) const;
  std::string text_of(std::string_view key, const Node& node, std::string_view expected) const;
  std::string scalar_of(std::string_view key, const Node& node) const;
  double number_of(std::string_view key, const Node& node, const Range& range) const;
  std::int64_t integer_of(std::string_view key, const Node& node, std::int64_t min,
                          std::int64_t max) const;
  std::string child_path(std::string_view key) const;

  const Node* table_;
  std::string path_;
  std::string file_;
};

/// A parsed file.
class Document {
 public:
  /// Of at most 1 MiB. @throws as os::read_file and `parse`.
  static Document load(const std::filesystem::path& file);
  /// `file` is for the messages. @throws Error(kBadFile) with the line of a syntax error.
  static Document parse(std::string_view text, const std::string& file);

  Table root(Keys allowed) const;
  Table root() const;

  /// Replaces the value at a path ("uav.sensors.camera.rate_hz") wherever the file has it: of an
  /// array of tables, in each one that does. `text`: a number, a boolean or an array of values as
  /// in TOML; anything else is a string. Returns how many values were replaced. Invalidates tables.
  std::size_t replace(std::string_view path, const std::string& text);
  /// The same where the file has no value at the path yet. The tables on the path need not exist.
  std::size_t add(std::string_view path, const std::string& text);

 private:
  struct Delete {
    void operator()(Node* node) const;
  };
  Document(std::unique_ptr<Node, Delete> tree, std::string file)
      : tree_(std::move(tree)), file_(std::move(file)) {}

  std::unique_ptr<Node, Delete> tree_;
  std::string file_;
};

/// The line of the key, in whichever table the file has it. No line if it is there several times,
/// or the file cannot be read.
FileLocation place_of(const std::filesystem::path& file, std::string_view key);

/// For the target's side, which does not throw: the value that `read` returns, or kInvalid with the
/// message of the Error that it throws.
template <class Read>
auto result_of(const Read& read) -> Result<decltype(read())> {
  try {
    return read();
  } catch (const Error& error) {
    return Failure{Failure::Kind::kInvalid, error.what()};
  }
}

/// The shortest text that reads back as the same number: "25", "0.1", "1e-05", "nan".
std::string number_text(double number);

}  // namespace tether::toml
