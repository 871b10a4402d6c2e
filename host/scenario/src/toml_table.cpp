#include "toml_table.h"

#include "suggest.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

namespace tether::scenario {
namespace {

std::string describe(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return fmt::format("the string \"{}\"", node.as_string()->get());
    case toml::node_type::integer:
      return fmt::format("the integer {}", node.as_integer()->get());
    case toml::node_type::floating_point:
      return fmt::format("the number {}", node.as_floating_point()->get());
    case toml::node_type::boolean:
      return node.as_boolean()->get() ? "the boolean true" : "the boolean false";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::table:
      return "a table";
    default:
      return "a date or time";
  }
}

bool is_identifier(std::string_view text) {
  constexpr std::string_view kAllowed =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-.";
  return !text.empty() && text.size() <= 64 && text.front() != '.' &&
         text.find_first_not_of(kAllowed) == std::string_view::npos;
}

double seconds_per_unit(std::string_view key) {
  return key.ends_with("ms") ? 1e-3 : 1.0;
}

/// Folders, devices and pipes are not read: a read of some of them would never end.
/// @pre it is no regular file
std::string_view why_no_file(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) ? "that is no regular file"
                                                : "there is no such file";
}

}  // namespace

bool Range::contains(double value) const {
  return std::isfinite(value) && (above_min ? value > min : value >= min) &&
         (below_max ? value < max : value <= max);
}

std::string Range::text() const {
  const bool has_min = std::isfinite(min), has_max = std::isfinite(max);
  std::string text;
  if (has_min) text = fmt::format("{} {}", above_min ? "greater than" : "at least", min);
  if (has_max) {
    text +=
        fmt::format("{}{} {}", has_min ? " and " : "", below_max ? "less than" : "at most", max);
  }
  return text.empty() ? "finite" : text;
}

TomlTable::TomlTable(const toml::table& table, std::string path, std::string file)
    : table_(&table), path_(std::move(path)), file_(std::move(file)) {}

TomlTable::TomlTable(const toml::table& table, std::string path, std::string file, Keys allowed)
    : TomlTable(table, std::move(path), std::move(file)) {
  require_keys_in({allowed.begin(), allowed.size()});
}

void TomlTable::require_keys_in(std::span<const std::string_view> allowed) const {
  for (const auto& [key, node] : *table_) {
    if (std::find(allowed.begin(), allowed.end(), key.str()) != allowed.end()) continue;
    const FileLocation at{file_, static_cast<int>(key.source().begin.line)};
    throw Error(ErrorCode::kBadFile, at,
                fmt::format("unknown key '{}' in {}; {}", key.str(), title(),
                            allowed_hint(key.str(), allowed)));
  }
}

// Locations and messages.

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> keys;
  for (const auto& [key, node] : *table_) keys.emplace_back(key.str());
  return keys;
}

std::string TomlTable::title() const {
  return path_.empty() ? "the file" : "[" + path_ + "]";
}

std::string TomlTable::child_path(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

FileLocation TomlTable::where() const {
  const int line = path_.empty() ? 0 : static_cast<int>(table_->source().begin.line);
  return {file_, line};
}

FileLocation TomlTable::where(std::string_view key) const {
  for (const auto& [name, node] : *table_) {
    if (name.str() == key) return {file_, static_cast<int>(name.source().begin.line)};
  }
  return where();
}

void TomlTable::fail(std::string_view key, const std::string& problem) const {
  throw Error(ErrorCode::kBadFile, where(key), fmt::format("'{}' of {} {}", key, title(), problem));
}

void TomlTable::fail(const std::string& problem) const {
  throw Error(ErrorCode::kBadFile, where(), title() + " " + problem);
}

void TomlTable::fail_type(std::string_view key, const toml::node& found,
                          std::string_view expected) const {
  fail(key, fmt::format("must be {}, but is {}", expected, describe(found)));
}

const toml::node& TomlTable::required(std::string_view key) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) fail(fmt::format("lacks the key '{}'", key));
  return *node;
}

// Scalars.

std::string TomlTable::text(std::string_view key) const {
  const toml::node& node = required(key);
  if (!node.is_string()) fail_type(key, node, "a string");
  const std::string& text = node.as_string()->get();
  if (text.empty()) fail(key, "must not be empty");
  if (text.find('\0') != std::string::npos) fail(key, "must not contain a NUL character");
  return text;
}

std::string TomlTable::text_or(std::string_view key, std::string_view fallback) const {
  return has(key) ? text(key) : std::string(fallback);
}

std::string TomlTable::identifier(std::string_view key) const {
  const std::string name = text(key);
  if (!is_identifier(name)) {
    fail(key, fmt::format("must be 1 to 64 letters, digits, '_', '-' and '.', not starting with "
                          "'.', but is \"{}\"",
                          name));
  }
  return name;
}

double TomlTable::number_of(std::string_view key, const toml::node& node,
                            const Range& range) const {
  if (!node.is_number()) fail_type(key, node, "a number");
  const double value = *node.value<double>();
  if (!range.contains(value)) fail(key, fmt::format("must be {}, but is {}", range.text(), value));
  return value;
}

double TomlTable::number(std::string_view key, const Range& range) const {
  return number_of(key, required(key), range);
}

double TomlTable::number_or(std::string_view key, const Range& range, double fallback) const {
  return has(key) ? number(key, range) : fallback;
}

std::optional<double> TomlTable::number_if(std::string_view key, const Range& range) const {
  return has(key) ? std::optional(number(key, range)) : std::nullopt;
}

std::int64_t TomlTable::integer_or(std::string_view key, std::int64_t min, std::int64_t max,
                                   std::int64_t fallback) const {
  if (!has(key)) return fallback;
  const toml::node& node = required(key);
  if (!node.is_integer()) fail_type(key, node, "an integer");
  const std::int64_t value = node.as_integer()->get();
  if (value < min || value > max) {
    fail(key, fmt::format("must be at least {} and at most {}, but is {}", min, max, value));
  }
  return value;
}

bool TomlTable::boolean_or(std::string_view key, bool fallback) const {
  if (!has(key)) return fallback;
  const toml::node& node = required(key);
  if (!node.is_boolean()) fail_type(key, node, "true or false");
  return node.as_boolean()->get();
}

Duration TomlTable::duration(std::string_view key, const Range& range) const {
  return duration_from_seconds(number(key, range) * seconds_per_unit(key));
}

Duration TomlTable::duration_or(std::string_view key, const Range& range, Duration fallback) const {
  return has(key) ? duration(key, range) : fallback;
}

std::size_t TomlTable::choice(std::string_view key,
                              std::span<const std::string_view> choices) const {
  const std::string word = text(key);
  const auto found = std::find(choices.begin(), choices.end(), word);
  if (found == choices.end()) {
    fail(key, fmt::format("is \"{}\"; {}", word, allowed_hint(word, choices)));
  }
  return static_cast<std::size_t>(found - choices.begin());
}

std::string TomlTable::scalar_as_text(std::string_view key) const {
  const toml::node& node = required(key);
  if (node.is_string()) return text(key);
  if (const auto* integer = node.as_integer()) return fmt::format("{}", integer->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* boolean = node.as_boolean()) return boolean->get() ? "true" : "false";
  fail_type(key, node, "a string, a number or a boolean");
}

std::filesystem::path TomlTable::existing_file(std::string_view key) const {
  namespace fs = std::filesystem;
  const std::string written = text(key);
  std::error_code ignored;
  const fs::path path = (fs::path(file_).parent_path() / written).lexically_normal();
  if (!fs::is_regular_file(path, ignored)) {
    fail(key, fmt::format("names \"{}\", but {} ({})", written, why_no_file(path), path.string()));
  }
  return path;
}

// Arrays and tables.

const toml::array& TomlTable::array(std::string_view key, std::string_view expected) const {
  const toml::node& node = required(key);
  if (!node.is_array()) fail_type(key, node, expected);
  return *node.as_array();
}

std::vector<std::string> TomlTable::texts(std::string_view key) const {
  std::vector<std::string> texts;
  for (const toml::node& element : array(key, "an array of strings")) {
    if (!element.is_string()) fail_type(key, element, "an array of strings only");
    const std::string& text = element.as_string()->get();
    if (text.empty()) fail(key, "must not contain an empty string");
    if (text.find('\0') != std::string::npos) fail(key, "must not contain a NUL character");
    texts.push_back(text);
  }
  return texts;
}

std::vector<std::string> TomlTable::texts_or_none(std::string_view key) const {
  return has(key) ? texts(key) : std::vector<std::string>{};
}

std::vector<double> TomlTable::numbers(std::string_view key, std::size_t count,
                                       const Range& range) const {
  const std::string expected = fmt::format("an array of {} numbers", count);
  const toml::array& elements = array(key, expected);
  if (elements.size() != count) {
    fail(key, fmt::format("must be {}, but has {} elements", expected, elements.size()));
  }
  std::vector<double> numbers;
  for (const toml::node& element : elements) numbers.push_back(number_of(key, element, range));
  return numbers;
}

std::vector<double> TomlTable::numbers(std::string_view key, const Range& range) const {
  std::vector<double> numbers;
  for (const toml::node& element : array(key, "an array of numbers")) {
    const double value = element.is_number() ? *element.value<double>() : NAN;
    if (!range.contains(value)) {
      throw Error(ErrorCode::kBadFile, {file_, static_cast<int>(element.source().begin.line)},
                  fmt::format("'{}' of {} must be numbers of {}, but has {}", key, title(),
                              range.text(), describe(element)));
    }
    numbers.push_back(value);
  }
  if (numbers.empty()) fail(key, "must hold at least one number, but is empty");
  return numbers;
}

std::vector<std::int64_t> TomlTable::integers(std::string_view key, std::int64_t min) const {
  std::vector<std::int64_t> integers;
  for (const toml::node& element : array(key, "an array of integers")) {
    if (!element.is_integer()) fail_type(key, element, "an array of integers only");
    integers.push_back(element.as_integer()->get());
    if (integers.back() < min) {
      fail(key, fmt::format("must be integers of at least {}, but has {}", min, integers.back()));
    }
  }
  return integers;
}

TomlTable TomlTable::table(std::string_view key) const {
  const toml::node& node = required(key);
  if (!node.is_table()) fail_type(key, node, "a table");
  return TomlTable(*node.as_table(), child_path(key), file_);
}

TomlTable TomlTable::table(std::string_view key, Keys allowed) const {
  const TomlTable any = table(key);
  return TomlTable(*any.table_, any.path_, any.file_, allowed);
}

TomlTable TomlTable::table(std::string_view key, std::span<const std::string_view> allowed) const {
  const TomlTable any = table(key);
  any.require_keys_in(allowed);
  return any;
}

std::vector<TomlTable> TomlTable::tables(std::string_view key, Keys allowed) const {
  const std::string expected = fmt::format("one or more tables [[{}]]", child_path(key));
  const toml::array& elements = array(key, expected);
  if (elements.empty()) fail(key, fmt::format("must be {}, but is an empty array", expected));
  std::vector<TomlTable> tables;
  for (const toml::node& element : elements) {
    if (!element.is_table()) fail_type(key, element, expected);
    tables.emplace_back(*element.as_table(), child_path(key), file_, allowed);
  }
  return tables;
}

std::vector<TomlTable> TomlTable::tables_or_none(std::string_view key, Keys allowed) const {
  return has(key) ? tables(key, allowed) : std::vector<TomlTable>{};
}

// Files.

std::string read_text_file(const std::filesystem::path& file, std::size_t limit) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed)) {
    throw Error(ErrorCode::kBadFile, FileLocation{file.string()}, std::string(why_no_file(file)));
  }
  const auto size = std::filesystem::file_size(file, failed);
  if (!failed && size > limit) {
    throw Error(ErrorCode::kBadFile, FileLocation{file.string()},
                fmt::format("is {} bytes long; at most {} are read", size, limit));
  }
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (size > 0) text << stream.rdbuf();
  if (failed || !stream || !text) {
    require_a_handle_for(file.string());
    throw Error(ErrorCode::kBadFile, FileLocation{file.string()}, "cannot be read");
  }
  return std::move(text).str();
}

toml::table parse_toml_file(const std::filesystem::path& file) {
  constexpr std::size_t kLargestFile = std::size_t{1} << 20;
  const std::string text = read_text_file(file, kLargestFile);
  try {
    return toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    const FileLocation at{file.string(), static_cast<int>(error.source().begin.line)};
    throw Error(ErrorCode::kBadFile, at, fmt::format("no valid TOML: {}", error.description()));
  }
}

}  // namespace tether::scenario
