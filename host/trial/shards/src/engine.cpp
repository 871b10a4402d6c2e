#include <algorithm>
#include <functional>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/base/text.h>
#include <tether/os/child_process.h>
#include <tether/shards/engine_flights.h>
#include <tether/toml/table.h>

namespace tether::shards {
namespace {

constexpr std::int64_t kMostShards = 100'000;

struct Value {
  std::string_view name;
  std::string (*of)(const EngineCall&);
};
constexpr Value kValues[] = {
    {"name", [](const EngineCall& call) { return call.name; }},
    {"folder", [](const EngineCall& call) { return os::shell_word(call.folder.string()); }},
    {"script", [](const EngineCall& call) { return os::shell_word(call.script.string()); }},
    {"shards", [](const EngineCall& call) { return std::to_string(call.shards); }},
    {"cores", [](const EngineCall& call) { return std::to_string(call.cores); }},
};

/// The name in the braces that begin at `at`; none: they are meant for somebody else, as ${HOME}.
std::optional<std::string> name_at(const std::string& text, std::size_t at) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz_";
  const std::size_t end = text.find_first_not_of(kLetters, at + 1);
  if (end == std::string::npos || end == at + 1 || text[end] != '}') return std::nullopt;
  return text.substr(at + 1, end - at - 1);
}

std::string replaced(const std::string& text,
                     const std::function<std::string(const std::string& name)>& value_of) {
  std::string all;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const auto name = text[at] == '{' ? name_at(text, at) : std::nullopt;
    all += name ? value_of(*name) : std::string(1, text[at]);
    if (name) at += name->size() + 1;
  }
  return all;
}

std::vector<std::string_view> names_of(const Engine& engine) {
  std::vector<std::string_view> names;
  for (const Value& value : kValues) names.push_back(value.name);
  for (const auto& [name, value] : engine.options) names.emplace_back(name);
  return names;
}

void require_known_names(const Engine& engine, const toml::Table& root) {
  const std::vector<std::string_view> names = names_of(engine);
  const auto check = [&](const char* key, const std::string& text) {
    (void)replaced(text, [&](const std::string& name) {
      if (std::ranges::find(names, name) == names.end())
        root.fail(key, fmt::format("has {{{}}}, which is no value of an engine and no option of "
                                   "this one; {}",
                                   name, allowed_hint(name, names)));
      return std::string();
    });
  };
  for (const std::string& word : engine.command) check("command", word);
  for (const std::string& word : engine.cancel) check("cancel", word);
  check("input", engine.input);
}

}  // namespace

bool Engine::gives_cores() const {
  const auto has = [](const std::string& text) {
    return text.find("{cores}") != std::string::npos;
  };
  return std::ranges::any_of(command, has) || has(input);
}

Engine load_engine(const std::filesystem::path& file) {
  const toml::Document document = toml::Document::load(file);
  const toml::Table root =
      document.root({"description", "command", "input", "cancel", "shards", "option"});
  Engine engine{.file = file, .command = root.texts("command")};
  (void)root.text_or("description", "");
  if (engine.command.empty())
    root.fail("command", "is empty. Name the program that runs the shards, and its arguments.");
  engine.input = root.text_or("input", "");
  engine.cancel = root.texts_or_none("cancel");
  engine.shards = static_cast<std::size_t>(root.integer_or("shards", 1, kMostShards, 1));
  for (const toml::Table& option : root.tables_or_none("option", {"name", "value", "about"})) {
    (void)option.text_or("about", "");
    engine.options[option.identifier("name")] =
        option.has("value") ? option.any_text("value") : std::string();
  }
  require_known_names(engine, root);
  return engine;
}

void set_options(Engine& engine, const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) {
    const std::string name = setting.substr(0, setting.find('='));
    const auto option = engine.options.find(name);
    if (option == engine.options.end() || name.size() == setting.size()) {
      std::vector<std::string_view> names;
      for (const auto& [known, value] : engine.options) names.emplace_back(known);
      throw Error(ErrorCode::kUsage,
                  fmt::format("--engine-option: '{}' is no NAME=VALUE of the engine {}; {}",
                              setting, engine.file.string(),
                              names.empty() ? "it has no options" : allowed_hint(name, names)))
          .about("--engine-option");
    }
    option->second = setting.substr(name.size() + 1);
  }
}

std::string filled(const std::string& text, const Engine& engine, const EngineCall& call) {
  return replaced(text, [&](const std::string& name) {
    const auto value = std::ranges::find(kValues, name, &Value::name);
    return value == std::end(kValues) ? engine.options.at(name) : value->of(call);
  });
}

std::vector<std::string> filled(const std::vector<std::string>& words, const Engine& engine,
                                const EngineCall& call) {
  std::vector<std::string> all;
  for (const std::string& word : words) all.push_back(filled(word, engine, call));
  return all;
}

}  // namespace tether::shards
