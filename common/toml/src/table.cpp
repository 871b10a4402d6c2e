#include "node.h"

#include <algorithm>
#include <cmath>

#include <tether/base/text.h>
#include <tether/os/text_file.h>
#include <tether/toml/table.h>

/// Values are checked where they are read. `required` finds the node of a key, `text_of`,
/// `number_of` and `integer_of` check one value, of a key or of an element, and the fail functions
/// build the message and the place of an error.
namespace tether::toml {
namespace {

std::string string_of(std::string_view view) {
  return std::string(view);
}

std::string describe(const ::toml::node& node) {
  switch (node.type()) {
    case ::toml::node_type::string:
      return "the string \"" + node.as_string()->get() + "\"";
    case ::toml::node_type::integer:
      return "the integer " + std::to_string(node.as_integer()->get());
    case ::toml::node_type::floating_point:
      return "the number " + number_text(node.as_floating_point()->get());
    case ::toml::node_type::boolean:
      return node.as_boolean()->get() ? "the boolean true" : "the boolean false";
    case ::toml::node_type::array:
      return "an array";
    case ::toml::node_type::table:
      return "a table";
    default:
      return "a date or time";
  }
}

/// "; line 7 has it in [uav.camera]. Write it above …", if a table below this one has the key.
std::string place_below(const ::toml::table& table, const std::string& path, std::string_view key) {
  for (const auto& [name, node] : table) {
    const ::toml::table* child = node.as_table();
    if (child == nullptr) continue;
    const std::string header = (path.empty() ? "" : path + ".") + string_of(name.str());
    if (const auto found = child->find(key); found != child->end())
      return "; line " + std::to_string(line_of(found->first.source())) + " has it in [" + header +
             "]. Write it above [" + header + "]";
    if (const std::string below = place_below(*child, header, key); !below.empty()) return below;
  }
  return "";
}

constexpr std::string_view kArrayOfStrings = "an array of strings";

bool is_identifier(std::string_view text) {
  constexpr std::string_view kAllowed =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-.";
  return !text.empty() && text.size() <= 64 && text.front() != '.' &&
         text.find_first_not_of(kAllowed) == std::string_view::npos;
}

double seconds_per_unit(std::string_view key) {
  return key.ends_with("ms") ? 1e-3 : 1.0;
}

}  // namespace

bool Range::contains(double value) const {
  if (with_inf && value == std::numeric_limits<double>::infinity()) return true;
  return std::isfinite(value) && (above_min ? value > min : value >= min) &&
         (below_max ? value < max : value <= max);
}

std::string Range::text() const {
  const bool has_min = std::isfinite(min), has_max = std::isfinite(max);
  std::string text;
  if (has_min) text = (above_min ? "greater than " : "at least ") + number_text(min);
  if (has_min && has_max) text += " and ";
  if (has_max) text += (below_max ? "less than " : "at most ") + number_text(max);
  if (text.empty()) text = "finite";
  return with_inf ? text + ", or inf" : text;
}

Table::Table(const Node& table, std::string path, std::string file)
    : table_(&table), path_(std::move(path)), file_(std::move(file)) {}

void Table::require_keys_in(std::span<const std::string_view> allowed) const {
  for (const auto& [key, node] : as_table(*table_)) {
    if (std::find(allowed.begin(), allowed.end(), key.str()) != allowed.end()) continue;
    throw Error(ErrorCode::kBadFile, {file_, line_of(key.source())},
                "unknown key '" + string_of(key.str()) + "' in " + title() + "; " +
                    allowed_hint(key.str(), allowed))
        .about(string_of(key.str()));
  }
}

// Locations and messages.

bool Table::has(std::string_view key) const {
  return as_table(*table_).contains(key);
}

std::vector<std::string> Table::keys() const {
  std::vector<std::string> keys;
  for (const auto& [key, node] : as_table(*table_)) keys.emplace_back(key.str());
  return keys;
}

std::string Table::title() const {
  return path_.empty() ? "the file" : "[" + path_ + "]";
}

std::string Table::child_path(std::string_view key) const {
  return (path_.empty() ? "" : path_ + ".") + string_of(key);
}

FileLocation Table::where() const {
  return {file_, path_.empty() ? 0 : line_of(raw(*table_).source())};
}

FileLocation Table::where(std::string_view key) const {
  const auto found = as_table(*table_).find(key);
  if (found == as_table(*table_).end()) return where();
  return {file_, line_of(found->first.source())};
}

void Table::fail(std::string_view key, const std::string& problem) const {
  fail_at(where(key), key, problem);
}

void Table::fail_at(const FileLocation& place, std::string_view key,
                    const std::string& problem) const {
  throw Error(ErrorCode::kBadFile, place, "'" + string_of(key) + "' of " + title() + " " + problem)
      .about(string_of(key));
}

void Table::fail_at(const Node& node, std::string_view key, const std::string& problem) const {
  fail_at({file_, line_of(raw(node).source())}, key, problem);
}

void Table::fail(const std::string& problem) const {
  throw Error(ErrorCode::kBadFile, where(), title() + " " + problem).about(title());
}

void Table::fail_type(std::string_view key, const Node& found, std::string_view expected) const {
  fail_at(found, key, "must be " + string_of(expected) + ", but is " + describe(raw(found)));
}

const Node& Table::required(std::string_view key) const {
  const ::toml::node* node = as_table(*table_).get(key);
  if (node == nullptr) {
    const bool is_empty = path_.empty() && as_table(*table_).empty();
    throw Error(ErrorCode::kBadFile, where(),
                (is_empty ? "the file is empty; it needs" : title() + " lacks") + " the key '" +
                    string_of(key) + "'" + place_below(as_table(*table_), path_, key))
        .about(string_of(key));
  }
  return opaque(*node);
}

// Scalars.

std::string Table::any_text(std::string_view key) const {
  const Node& node = required(key);
  if (!raw(node).is_string()) fail_type(key, node, "a string");
  return raw(node).as_string()->get();
}

std::string Table::text_of(std::string_view key, const Node& node,
                           std::string_view expected) const {
  if (!raw(node).is_string()) fail_type(key, node, expected);
  std::string text = raw(node).as_string()->get();
  if (text.empty()) fail_at(node, key, "must not be empty");
  if (text.find('\0') != std::string::npos) fail_at(node, key, "must not contain a NUL character");
  return text;
}

std::string Table::text(std::string_view key) const {
  return text_of(key, required(key), "a string");
}

std::string Table::text_or(std::string_view key, std::string_view fallback) const {
  return has(key) ? text(key) : std::string(fallback);
}

std::string Table::identifier(std::string_view key) const {
  const std::string name = text(key);
  if (!is_identifier(name)) {
    fail(key,
         "must be 1 to 64 letters, digits, '_', '-' and '.', not starting with '.', but is \"" +
             name + "\"");
  }
  return name;
}

double Table::number_of(std::string_view key, const Node& node, const Range& range) const {
  if (!raw(node).is_number()) fail_type(key, node, "a number");
  const double value = *raw(node).value<double>();
  if (!range.contains(value))
    fail_at(node, key, "must be " + range.text() + ", but is " + number_text(value));
  return value;
}

double Table::number(std::string_view key, const Range& range) const {
  return number_of(key, required(key), range);
}

double Table::number_or(std::string_view key, const Range& range, double fallback) const {
  return has(key) ? number(key, range) : fallback;
}

std::optional<double> Table::number_if(std::string_view key, const Range& range) const {
  return has(key) ? std::optional(number(key, range)) : std::nullopt;
}

std::int64_t Table::integer_of(std::string_view key, const Node& node, std::int64_t min,
                               std::int64_t max) const {
  if (!raw(node).is_integer()) fail_type(key, node, "an integer");
  const std::int64_t value = raw(node).as_integer()->get();
  if (value < min || value > max) {
    const bool has_max = max < std::numeric_limits<std::int64_t>::max();
    fail_at(node, key,
            "must be at least " + std::to_string(min) +
                (has_max ? " and at most " + std::to_string(max) : "") + ", but is " +
                std::to_string(value));
  }
  return value;
}

std::int64_t Table::integer(std::string_view key, std::int64_t min, std::int64_t max) const {
  return integer_of(key, required(key), min, max);
}

std::int64_t Table::integer_or(std::string_view key, std::int64_t min, std::int64_t max,
                               std::int64_t fallback) const {
  return has(key) ? integer(key, min, max) : fallback;
}

bool Table::boolean(std::string_view key) const {
  const Node& node = required(key);
  if (!raw(node).is_boolean()) fail_type(key, node, "true or false");
  return raw(node).as_boolean()->get();
}

bool Table::boolean_or(std::string_view key, bool fallback) const {
  return has(key) ? boolean(key) : fallback;
}

Duration Table::duration(std::string_view key, const Range& range) const {
  return duration_from_seconds(number(key, range) * seconds_per_unit(key));
}

Duration Table::duration_or(std::string_view key, const Range& range, Duration fallback) const {
  return has(key) ? duration(key, range) : fallback;
}

std::size_t Table::choice(std::string_view key, std::span<const std::string_view> choices) const {
  const std::string word = text(key);
  const auto found = std::find(choices.begin(), choices.end(), word);
  if (found == choices.end()) fail(key, "is \"" + word + "\"; " + allowed_hint(word, choices));
  return static_cast<std::size_t>(found - choices.begin());
}

std::string Table::scalar_as_text(std::string_view key) const {
  return scalar_of(key, required(key));
}

std::string Table::scalar_of(std::string_view key, const Node& node) const {
  if (raw(node).is_string()) return text_of(key, node, "a string");
  if (const auto* integer = raw(node).as_integer()) return std::to_string(integer->get());
  if (const auto* number = raw(node).as_floating_point()) return number_text(number->get());
  if (const auto* boolean = raw(node).as_boolean()) return boolean->get() ? "true" : "false";
  fail_type(key, node, "a string, a number or a boolean");
}

std::filesystem::path Table::existing_file(std::string_view key) const {
  namespace fs = std::filesystem;
  const std::string written = text(key);
  std::error_code ignored;
  const fs::path path = (fs::path(file_).parent_path() / written).lexically_normal();
  if (!fs::is_regular_file(path, ignored)) {
    const std::string full = path == written ? "" : " (" + path.string() + ")";
    fail(key, "names \"" + written + "\"" + full + ", but " + os::why_no_file(path));
  }
  return path;
}

// Arrays and tables.

std::vector<const Node*> Table::elements(std::string_view key, std::string_view expected) const {
  const Node& node = required(key);
  if (raw(node).is_string() && expected == kArrayOfStrings)
    fail_at(node, key,
            "must be " + string_of(expected) + ", but is " + describe(raw(node)) +
                ". Write it in brackets: [\"" + raw(node).as_string()->get() + "\"]");
  if (!raw(node).is_array()) fail_type(key, node, expected);
  std::vector<const Node*> elements;
  for (const ::toml::node& element : *raw(node).as_array()) elements.push_back(&opaque(element));
  return elements;
}

std::vector<std::string> Table::texts(std::string_view key) const {
  std::vector<std::string> texts;
  for (const Node* element : elements(key, kArrayOfStrings))
    texts.push_back(text_of(key, *element, "an array of strings only"));
  return texts;
}

std::vector<std::string> Table::texts_or_none(std::string_view key) const {
  return has(key) ? texts(key) : std::vector<std::string>{};
}

std::vector<double> Table::numbers(std::string_view key, std::size_t count,
                                   const Range& range) const {
  std::vector<double> all = numbers(key, range);
  if (all.size() != count) {
    fail(key, "must be an array of " + std::to_string(count) + " numbers, but has " +
                  std::to_string(all.size()) + " elements");
  }
  return all;
}

std::vector<double> Table::numbers(std::string_view key, const Range& range) const {
  std::vector<double> numbers;
  for (const Node* element : elements(key, "an array of numbers"))
    numbers.push_back(number_of(key, *element, range));
  if (numbers.empty()) fail(key, "must hold at least one number, but is empty");
  return numbers;
}

std::vector<std::int64_t> Table::integers(std::string_view key, std::int64_t min) const {
  std::vector<std::int64_t> integers;
  for (const Node* element : elements(key, "an array of integers"))
    integers.push_back(integer_of(key, *element, min, std::numeric_limits<std::int64_t>::max()));
  return integers;
}

std::vector<std::string> Table::scalars_as_texts(std::string_view key) const {
  std::vector<std::string> texts;
  for (const Node* element : elements(key, "an array")) {
    if (raw(*element).is_array())
      fail_type(key, *element, "an array of strings, numbers or booleans, not of arrays");
    texts.push_back(scalar_of(key, *element));
  }
  if (texts.empty()) fail(key, "must have at least one value, but is empty");
  return texts;
}

bool Table::is_table(std::string_view key) const {
  return raw(required(key)).is_table();
}

bool Table::is_text(std::string_view key) const {
  return raw(required(key)).is_string();
}

Table Table::table(std::string_view key) const {
  const Node& node = required(key);
  if (!raw(node).is_table()) fail_type(key, node, "a table");
  return {node, child_path(key), file_};
}

Table Table::table(std::string_view key, Keys allowed) const {
  return table(key, std::span(allowed.begin(), allowed.size()));
}

Table Table::table(std::string_view key, std::span<const std::string_view> allowed) const {
  Table any = table(key);
  any.require_keys_in(allowed);
  return any;
}

std::vector<Table> Table::tables(std::string_view key) const {
  const std::string expected = "one or more tables [[" + child_path(key) + "]]";
  if (raw(required(key)).is_table())
    fail_at(required(key), key,
            "may be there several times. Write [[" + child_path(key) + "]] in place of [" +
                child_path(key) + "]");
  const std::vector<const Node*> all = elements(key, expected);
  if (all.empty()) fail(key, "must be " + expected + ", but is an empty array");
  std::vector<Table> tables;
  for (const Node* element : all) {
    if (!raw(*element).is_table()) fail_type(key, *element, expected);
    tables.push_back({*element, child_path(key), file_});
  }
  return tables;
}

std::vector<Table> Table::tables(std::string_view key, Keys allowed) const {
  return tables(key, std::span(allowed.begin(), allowed.size()));
}

std::vector<Table> Table::tables(std::string_view key,
                                 std::span<const std::string_view> allowed) const {
  std::vector<Table> any = tables(key);
  for (const Table& table : any) table.require_keys_in(allowed);
  return any;
}

std::vector<Table> Table::tables_or_none(std::string_view key, Keys allowed) const {
  return has(key) ? tables(key, allowed) : std::vector<Table>{};
}

}  // namespace tether::toml
