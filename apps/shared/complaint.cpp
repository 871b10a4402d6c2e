#include "shared/complaint.h"

#include "shared/value.h"

#include <string_view>
#include <vector>

#include <tether/base/text.h>

namespace tether::app {

namespace {

/// The command that was given last: the program itself if there is none.
const CLI::App& innermost(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? app : innermost(*chosen.front());
}

/// "tether run".
std::string command_words(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return parent ? command_words(*parent) + " " + command.get_name() : command.get_name();
}

const CLI::App& program_of(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return parent ? program_of(*parent) : command;
}

/// The commands that have this option: "tether run, tether size".
std::string commands_with(const CLI::App& program, const std::string& option) {
  std::string words;
  for (const CLI::App* command : subcommands_of(program)) {
    if (command->get_option_no_throw(option) != nullptr)
      words += (words.empty() ? "" : ", ") + command_words(*command);
    if (const std::string further = commands_with(*command, option); !further.empty())
      words += (words.empty() ? "" : ", ") + further;
  }
  return words;
}

/// Of an option whose text cannot be made a number; empty: it is another error.
std::string no_number(const CLI::App& command, const CLI::ParseError& error) {
  const std::string_view words = error.what();
  for (const CLI::Option* option : command.get_options()) {
    const std::string begin = "Could not convert: " + option->get_name() + " = ";
    if (!words.starts_with(begin)) continue;
    const Value value = value_of(*option);
    return option->get_name() + ": must be a " + (value.is_whole ? "whole number" : "number") +
           (value.range.empty() ? "" : " from " + value.range) + ", but is '" +
           std::string(words.substr(begin.size())) + "'.";
  }
  return "";
}

/// Of an option that takes several numbers, and got others than so many; empty: it is another
/// error.
std::string wrong_count(const CLI::App& command, const CLI::ParseError& error) {
  if (error.get_name() != "ArgumentMismatch") return "";
  for (const CLI::Option* option : command.get_options()) {
    const int wanted = option->get_expected_min();
    if (wanted > 1 && std::string_view(error.what()).starts_with(option->get_name() + ":"))
      return option->get_name() + ": must be " + std::to_string(wanted) +
             " values with a comma between them" +
             (option->get_default_str().empty() ? "."
                                                : ", as in " + option->get_default_str() + ".");
  }
  return "";
}

/// First a word that is neither a command, an option nor an argument, with the nearest one that is.
std::string what_is_wrong(const CLI::App& command, const CLI::ParseError& error,
                          const std::function<std::string(const std::string&)>& advice) {
  const std::vector<std::string> rest = command.remaining();
  const auto subcommands = subcommands_of(command);
  std::vector<std::string> known;
  for (const CLI::App* sub : subcommands) known.push_back(sub->get_name());
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  const std::vector<std::string_view> candidates(known.begin(), known.end());
  for (const std::string& word : rest) {
    const std::string given = word.substr(0, word.find('='));
    if (const std::string_view near = nearest(given, candidates); !near.empty())
      return std::string("unknown ") + (given.starts_with('-') ? "option" : "command") + " '" +
             given + "'; did you mean '" + std::string(near) + "'?";
  }
  if (rest.empty() && error.get_name() == "RequiredError" && !subcommands.empty())
    return "no command is given.";
  if (rest.empty()) {
    for (const auto& explained : {no_number(command, error), wrong_count(command, error)})
      if (!explained.empty()) return explained;
    return std::string(error.what()) + ".";
  }
  const std::string given = rest.front().substr(0, rest.front().find('='));
  for (const std::string& option : known)
    if (given.size() > 3 && option.ends_with("-" + given.substr(2)))
      return "unknown option '" + given + "'; did you mean '" + option + "'?";
  if (const std::string others = commands_with(program_of(command), given); !others.empty())
    return "'" + given + "' is an option of " + others + ", not of this command.";
  const std::string help = advice ? advice(given) : "";
  return std::string("unexpected ") +
         (rest.front().starts_with('-') ? "option"
          : subcommands.empty()         ? "argument"
                                        : "command") +
         " '" + rest.front() + "'." + (help.empty() ? "" : " " + help);
}

}  // namespace

std::string complaint(const CLI::App& program, const CLI::ParseError& error,
                      const std::function<std::string(const std::string&)>& advice) {
  const CLI::App& command = innermost(program);
  return what_is_wrong(command, error, advice) + " For help, type: " + command_words(command) +
         " --help";
}

}  // namespace tether::app
