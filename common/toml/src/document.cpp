#include "node.h"
#include "syntax_error.h"

#include <algorithm>
#include <exception>

#include <tether/os/text_file.h>

/// Whole files: parsing, where a key is, and values that replace those of the file.
namespace tether::toml {
namespace {

constexpr std::size_t kLargestFile = std::size_t{1} << 20;

}  // namespace

void Document::Delete::operator()(Node* node) const {
  delete &as_table(*node);
}

Document Document::load(const std::filesystem::path& file) {
  constexpr std::string_view kElf =
      "\x7f"
      "ELF";
  if (os::begin_of(file, kElf.size()) == kElf)
    throw Error(ErrorCode::kBadFile, {file.string()}, "is a program, not a TOML file");
  return parse(os::read_file(file, kLargestFile), file.string());
}

Document Document::parse(std::string_view text, const std::string& file) {
  if (const std::string why = wrong_encoding(text); !why.empty())
    throw Error(ErrorCode::kBadFile, {file, 1}, why);
  try {
    auto tree = std::make_unique<::toml::table>(::toml::parse(text, file));
    return {std::unique_ptr<Node, Delete>(reinterpret_cast<Node*>(tree.release())),  // NOLINT
            file};
  } catch (const ::toml::parse_error& error) {
    const int line = line_of(error.source());
    throw Error(ErrorCode::kBadFile, {file, line},
                syntax_error(line_of_text(text, line), error.description()));
  }
}

namespace {

/// Adds the lines at which the tree has the key.
void add_lines(const ::toml::node& node, std::string_view key, std::vector<int>& lines) {
  if (const ::toml::array* array = node.as_array())
    for (const ::toml::node& element : *array) add_lines(element, key, lines);
  if (const ::toml::table* table = node.as_table())
    for (const auto& [name, value] : *table) {
      if (name.str() == key) lines.push_back(line_of(name.source()));
      add_lines(value, key, lines);
    }
}

bool is_list_of_values(const ::toml::node& node) {
  const ::toml::array* array = node.as_array();
  return array != nullptr && std::ranges::all_of(*array, [](const ::toml::node& element) {
           return element.is_value();
         });
}

/// The number, boolean or array that `text` is, or itself, as if it stood on that line of the file.
void replace_value(::toml::table& table, std::string_view key, const std::string& text, int line) {
  const std::string before(static_cast<std::size_t>(std::max(0, line - 1)), '\n');
  try {
    ::toml::table parsed = ::toml::parse(before + "value = " + text);
    ::toml::node* value = parsed.size() == 1 ? parsed.get("value") : nullptr;
    if (value != nullptr &&
        (value->is_number() || value->is_boolean() || is_list_of_values(*value))) {
      // A copy has no line.
      value->visit([&](auto& own) {
        if (line > 0)
          table.insert_or_assign(key, std::move(own));
        else
          table.insert_or_assign(key, own);
      });
      return;
    }
  } catch (const ::toml::parse_error&) {  // a string
  }
  table.insert_or_assign(key, text);
}

/// `adds`: only where the key is missing, which is added, in a new table if need be.
std::size_t replace_in(::toml::node& node, std::string_view path, const std::string& text,
                       bool adds) {
  std::size_t replaced = 0;
  if (::toml::array* array = node.as_array()) {
    for (::toml::node& element : *array) replaced += replace_in(element, path, text, adds);
    return replaced;
  }
  ::toml::table* table = node.as_table();
  if (table == nullptr) return 0;
  const std::size_t dot = path.find('.');
  const std::string_view key = path.substr(0, dot);
  const bool is_last = dot == std::string_view::npos;
  if (adds && !is_last && !table->contains(key)) table->insert(key, ::toml::table{});
  ::toml::node* child = table->get(key);
  if (child != nullptr && !is_last) return replace_in(*child, path.substr(dot + 1), text, adds);
  if (!is_last || (child == nullptr) != adds) return 0;
  if (child != nullptr && !child->is_value() && !is_list_of_values(*child)) return 0;
  replace_value(*table, key, text, child == nullptr ? 0 : line_of(child->source()));
  return 1;
}

}  // namespace

std::size_t Document::replace(std::string_view path, const std::string& text) {
  return replace_in(reinterpret_cast<::toml::table&>(*tree_), path, text, false);  // NOLINT
}

std::size_t Document::add(std::string_view path, const std::string& text) {
  return replace_in(reinterpret_cast<::toml::table&>(*tree_), path, text, true);  // NOLINT
}

Table Document::root() const {
  return {*tree_, "", file_};
}

Table Document::root(Keys allowed) const {
  Table any = root();
  any.require_keys_in({allowed.begin(), allowed.size()});
  return any;
}

FileLocation place_of(const std::filesystem::path& file, std::string_view key) try {
  std::vector<int> lines;
  add_lines(::toml::parse(os::read_file(file, kLargestFile)), key, lines);
  return {file.string(), lines.size() == 1 ? lines.front() : 0};
} catch (const std::exception&) {  // its reader says why
  return {file.string()};
}

}  // namespace tether::toml
