#include "tables/read_sut.h"

#include "files/named_file.h"

#include <algorithm>
#include <array>
#include <map>
#include <sstream>

#include <fmt/format.h>

namespace tether::scenario {
namespace {

using Parameters = std::vector<std::pair<std::string, std::string>>;

void require_option_name(const toml::Table& table, const std::string& key) {
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyz0123456789_";
  const bool starts_with_letter = !key.empty() && key.front() >= 'a' && key.front() <= 'z';
  if (starts_with_letter && key.find_first_not_of(kAllowed) == std::string::npos) return;
  table.fail(
      key,
      "must be lower-case letters, digits and '_', starting with a letter, because it becomes "
      "an option of the SUT's command line");
}

void read_values(const toml::Table& sut, Parameters& parameters) {
  if (!sut.has("parameters")) return;
  const toml::Table table = sut.table("parameters");
  for (const std::string& key : table.keys()) {
    require_option_name(table, key);
    parameters.emplace_back(key, table.scalar_as_text(key));
  }
}

// The SUT's working folder is not the scenario's, so its files are given by their absolute paths.
void read_files(const toml::Table& sut, Parameters& parameters,
                std::vector<std::filesystem::path>& files) {
  if (!sut.has("files")) return;
  const toml::Table table = sut.table("files");
  for (const std::string& key : table.keys()) {
    require_option_name(table, key);
    if (sut.has("parameters") && sut.table("parameters").has(key))
      table.fail(key, "is already a key of 'parameters'");
    files.push_back(table.existing_file(key));
    parameters.emplace_back(key, files.back().string());
  }
}

Parameters read_parameters(const toml::Table& sut, std::vector<std::filesystem::path>& files) {
  Parameters parameters;
  read_values(sut, parameters);
  read_files(sut, parameters, files);
  std::sort(parameters.begin(), parameters.end());
  return parameters;
}

// The words of a command line as the elements of an array.
std::string in_quotes(const std::string& line) {
  std::istringstream words(line);
  std::string all;
  for (std::string word; words >> word;) all += (all.empty() ? "\"" : ", \"") + word + '"';
  return all;
}

// Whether the program exists is checked when the run starts: it may exist on a board only.
std::vector<std::string> read_command(const toml::Table& sut, const std::filesystem::path& folder) {
  if (sut.has("command") && sut.is_text("command"))
    sut.fail("command", fmt::format("must be an array of the program and its arguments. Write "
                                    "command = [{}]",
                                    in_quotes(sut.text("command"))));
  std::vector<std::string> command = sut.texts("command");
  if (command.empty()) sut.fail("command", "is empty. Name a program.");
  std::string& program = command.front();
  if (program.find('/') == std::string::npos) return command;
  program = (folder / program).lexically_normal().string();
  return command;
}

constexpr std::array<std::string_view, 7> kSutKeys = {
    "command", "concurrent", "as_is", "all_processes", "mission", "parameters", "files"};

// The SUT gets it as a file. Its clauses are checked against what the scenario has.
void read_mission(const toml::Table& table, Scenario& scenario, Sut& sut) {
  if (!table.has("mission")) return;
  for (const char* other : {"parameters", "files"})
    if (table.has(other) && table.table(other).has("mission"))
      table.fail("mission", fmt::format("is already a key of '{}'", other));
  const std::filesystem::path file = named_file(table, "mission", ShippedKind::kMission);
  sut.mission = mission::load_mission(file);
  scenario.files.push_back(file);
  if (sut.is_as_is) return;  // it knows nothing of missions
  sut.parameters.emplace_back("mission", file.string());
  std::sort(sut.parameters.begin(), sut.parameters.end());
}

Sut read_program(const toml::Table& sut, const std::filesystem::path& folder) {
  Sut program{read_command(sut, folder), {}, sut.boolean_or("concurrent", false)};
  program.is_as_is = sut.boolean_or("as_is", false);
  program.has_all_processes = sut.boolean_or("all_processes", false);
  return program;
}

// Nested supervisors would wait for each other.
void require_one_supervisor(const toml::Table& table, const Sut& sut) {
  const std::filesystem::path program = sut.command.front();
  if (sut.concurrent && sut.is_as_is)
    table.fail(table.has("concurrent") ? "concurrent" : "as_is",
               "is for programs that use Tether's library, and 'as_is' for those that do not. "
               "Remove one.");
  if (sut.has_all_processes && !sut.is_as_is)
    table.fail(table.has("all_processes") ? "all_processes" : "as_is",
               "is for programs that fly as they are. Add as_is = true.");
  if ((!sut.concurrent && !sut.is_as_is) || program.filename() != "tether-exec") return;
  table.fail(table.has("concurrent") ? "concurrent"
             : table.has("as_is")    ? "as_is"
                                     : "command",
             "starts the command under tether-exec, which 'command' does already. Remove "
             "\"tether-exec\" and its options from 'command'.");
}

Parameters merged(const Parameters& defaults, const Parameters& own) {
  std::map<std::string, std::string> all(own.begin(), own.end());
  all.insert(defaults.begin(), defaults.end());
  return {all.begin(), all.end()};
}

}  // namespace

std::optional<Sut> read_default_sut(const toml::Table& root, Scenario& scenario) {
  if (!root.has("sut")) return std::nullopt;
  const toml::Table table = root.table("sut", kSutKeys);
  Sut sut = read_program(table, scenario.file.parent_path());
  require_one_supervisor(table, sut);
  sut.parameters = read_parameters(table, scenario.files);
  read_mission(table, scenario, sut);
  return sut;
}

Sut read_sut(const toml::Table& uav, const std::optional<Sut>& fallback, Scenario& scenario) {
  if (!uav.has("sut")) {
    if (!fallback)
      uav.fail("has no SUT. Add a table [sut] for all UAVs, or [uav.sut] for this one.");
    return *fallback;
  }
  const toml::Table own = uav.table("sut", kSutKeys);
  const bool inherits = fallback && !own.has("command");
  Sut sut = inherits ? *fallback : read_program(own, scenario.file.parent_path());
  sut.concurrent = own.boolean_or("concurrent", sut.concurrent);
  sut.is_as_is = own.boolean_or("as_is", sut.is_as_is);
  sut.has_all_processes = own.boolean_or("all_processes", sut.has_all_processes);
  require_one_supervisor(own, sut);
  Sut given;
  given.parameters = read_parameters(own, scenario.files);
  read_mission(own, scenario, given);
  const bool has_mission = std::ranges::any_of(
      given.parameters, [](const auto& parameter) { return parameter.first == "mission"; });
  if (has_mission) sut.mission = given.mission;
  sut.parameters = merged(sut.parameters, given.parameters);
  return sut;
}

}  // namespace tether::scenario
