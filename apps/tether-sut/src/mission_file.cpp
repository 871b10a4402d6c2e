#include "mission_file.h"

#include "common_arguments.h"
#include "task_arguments.h"
#include "toml_input.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

namespace tether::sut {
namespace {

/// One key of the file: an option's value, as the command line would have it.
struct Entry {
  std::string value;
  int line = 0;
};
using Entries = std::map<std::string, Entry, std::less<>>;

std::string option_name(std::string_view key) {
  std::string name = "--" + std::string(key);
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

/// CLI11's words about "--precision-deg" as words about "precision_deg".
std::string in_words_of_the_file(std::string text) {
  for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--", at)) {
    text.erase(at, 2);
    for (; at < text.size() &&
           (std::isalnum(static_cast<unsigned char>(text[at])) || text[at] == '-');
         ++at) {
      text[at] = text[at] == '-' ? '_' : text[at];
    }
  }
  return text;
}

std::string text_of(double number) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number);
  return {digits.data(), end.ptr};
}

std::string text_of(std::string_view key, const toml::node& node) {
  if (const auto* text = node.as_string()) {
    return text->get();
  }
  if (const auto* number = node.as_integer()) {
    return std::to_string(number->get());
  }
  if (const auto* number = node.as_floating_point()) {
    return text_of(number->get());
  }
  if (const auto* truth = node.as_boolean()) {
    return truth->get() ? "true" : "false";
  }
  throw BadInput{line_of(node), std::string(key) + " must be a string, a number, true or false"};
}

/// Takes what is not there yet, so that whoever comes first is heard.
void take(const toml::table& table, const std::vector<std::string_view>& but, Entries& entries) {
  for (const auto& [key, node] : table) {
    if (std::find(but.begin(), but.end(), key.str()) == but.end()) {
      const int line = line_of(key);
      entries.emplace(key.str(), Entry{text_of(key.str(), node), line});
    }
  }
}

/// One task's subcommand, with nothing around it.
class TaskParser {
 public:
  explicit TaskParser(std::string_view task) : arguments_(make_task_arguments(task)) {
    if (arguments_ != nullptr) {
      app_.set_help_flag();
      arguments_->add_to(app_);
    }
  }

  bool exists() const { return arguments_ != nullptr; }
  bool knows(std::string_view key) const {
    const bool is_plain = key.find('-') == std::string_view::npos;
    return is_plain && app_.get_option_no_throw(option_name(key)) != nullptr;
  }
  /// What is wrong with these, if anything.
  std::optional<std::string> parse(const Entries& entries) {
    std::vector<std::string> words;
    for (const auto& [key, entry] : entries) {
      words.push_back(option_name(key) + "=" + entry.value);
    }
    try {
      app_.parse(words);
    } catch (const CLI::RequiredError& error) {
      is_incomplete_ = true;
      return in_words_of_the_file(error.what());
    } catch (const CLI::ParseError& error) {
      return in_words_of_the_file(error.what());
    }
    return std::nullopt;
  }
  bool is_incomplete() const { return is_incomplete_; }
  TaskSpec spec() const { return arguments_->spec(); }

 private:
  std::unique_ptr<TaskArguments> arguments_;
  CLI::App app_;
  bool is_incomplete_ = false;
};

/// Each alone, because CLI11 does not say which of several is wrong.
void check_each(std::string_view task, const Entries& entries) {
  for (const auto& [key, entry] : entries) {
    TaskParser parser(task);
    const auto wrong = parser.parse({{key, entry}});
    if (wrong && !parser.is_incomplete()) {
      throw BadInput{entry.line, *wrong};
    }
  }
}

std::string names_of_tasks() {
  std::string names;
  for (const auto& arguments : all_task_arguments()) {
    names += (names.empty() ? "" : ", ") + std::string(arguments->name());
  }
  return names;
}

std::string name_of_task(const toml::table& table) {
  const toml::node* node = table.get("task");
  if (node == nullptr || !node->is_string()) {
    throw BadInput{node != nullptr ? line_of(*node) : line_of(table),
                   "a [[task]] needs task = \"NAME\"; there are " + names_of_tasks()};
  }
  const std::string name = node->as_string()->get();
  if (!TaskParser(name).exists()) {
    throw BadInput{line_of(*node),
                   "there is no task \"" + name + "\"; there are " + names_of_tasks()};
  }
  return name;
}

bool is_required(const toml::table& table) {
  const toml::node* node = table.get("required");
  if (node != nullptr && !node->is_boolean()) {
    throw BadInput{line_of(*node), "required must be true or false"};
  }
  return node == nullptr || node->as_boolean()->get();
}

TaskSpec read_task(const toml::table& table, const Entries& common) {
  const std::string name = name_of_task(table);
  TaskParser parser(name);
  Entries entries;
  take(table, {"task", "required"}, entries);
  for (const auto& [key, entry] : entries) {
    if (!parser.knows(key)) {
      throw BadInput{entry.line, name + " has no parameter '" + key + "' (tether-sut " + name +
                                     " --help lists them)"};
    }
  }
  for (const auto& [key, entry] : common) {
    if (parser.knows(key)) {
      entries.emplace(key, entry);
    }
  }
  check_each(name, entries);
  if (const auto wrong = parser.parse(entries)) {
    throw BadInput{line_of(table), name + ": " + *wrong};
  }
  TaskSpec spec = parser.spec();
  spec.required = is_required(table);
  return spec;
}

bool any_task_knows(const std::string& key) {
  const auto all = all_task_arguments();
  return std::any_of(all.begin(), all.end(),
                     [&](const auto& task) { return TaskParser(task->name()).knows(key); });
}

/// What the tasks share: the keys of `[vision]`, which are those of the options about vision, and
/// those at the top.
Entries read_common(const toml::table& file) {
  Entries common;
  if (const toml::node* node = file.get("vision")) {
    if (!node->is_table()) {
      throw BadInput{line_of(*node), "vision must be a table: [vision]"};
    }
    take(*node->as_table(), {}, common);
    TaskSpec spec;
    CLI::App vision;
    vision.set_help_flag();
    add_vision_options(vision, spec);
    for (const auto& [key, entry] : common) {
      if (vision.get_option_no_throw(option_name(key)) == nullptr) {
        throw BadInput{entry.line, "[vision] has no parameter '" + key + "'"};
      }
    }
  }
  take(file, {"vision", "task"}, common);
  for (const auto& [key, entry] : common) {
    if (!any_task_knows(key)) {
      throw BadInput{entry.line, "no task has a parameter '" + key + "'"};
    }
  }
  return common;
}

Mission read_mission(const toml::table& file) {
  const toml::node* node = file.get("task");
  if (node == nullptr || !node->is_array_of_tables()) {
    throw BadInput{node != nullptr ? line_of(*node) : 1, "a mission needs a [[task]] or more"};
  }
  const Entries common = read_common(file);
  Mission mission;
  mission.is_sequence = true;
  for (const toml::node& task : *node->as_array()) {
    mission.tasks.push_back(read_task(*task.as_table(), common));
  }
  return mission;
}

}  // namespace

Result<Mission> parse_mission(const std::string& text, const std::string& path) {
  return read_toml<Mission>(text, path, read_mission);
}

Result<Mission> load_mission(const std::string& path) {
  const Result<std::string> text = read_text(path, "mission file");
  if (!text) {
    return text.failure();
  }
  return parse_mission(*text, path);
}

}  // namespace tether::sut
