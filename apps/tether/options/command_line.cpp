#include "options/command_line.h"

#include "commands/commands.h"
#include "options/junit_option.h"
#include "shared/command.h"
#include "shared/complaint.h"
#include "shared/completion.h"
#include "shared/help.h"
#include "shared/manual.h"
#include "terminal/print.h"

#include <algorithm>
#include <functional>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/base/version.h>
#include <tether/os/child_process.h>
#include <tether/os/terminal.h>
#include <tether/scenario/shipped_files.h>

// The parser of all commands. Of this program, only this source includes CLI11, which is expensive
// to compile.
namespace tether::app {

namespace {

constexpr const char* kFooter =
    R"(Exit codes: 0 goal reached, 1 goal missed, 2 wrong use or a bad file, 3 set-up failed, or no
answer because a program waited or computed in ways that Tether does not see.

Examples:
  tether run face_anchor
  tether run face_anchor --condition "target, no sync" --seed 7
  tether campaign face_anchor --out out/campaign
  tether size face_anchor --target six_times_slower
  tether audit out/campaign/face_anchor/host/seed-0001/record.mcap

`tether list` prints the shipped files. Guides: docs/guide of the source, or
/usr/share/doc/tether/guide.)";

std::vector<Command> commands() {
  return {
      run_command(),
      campaign_command(),
      size_command(),
      report_command(),
      audit_command(),
      timing_command(),
      frames_command(),
      plot_command(),
      {"world", "Check worlds before a flight", {}, "Examples:\n  tether world check room"},
      world_check_command(),
      {"model", "Check UAVs before a flight", {}, "Examples:\n  tether model check hummingbird"},
      model_check_command(),
      {"target",
       "Check machines on which a SUT can run",
       {},
       "Examples:\n  tether target check ssh://pi@board.local"},
      target_check_command(),
      cache_command(),
      list_command()};
}

/// What to do about a word that no command takes here.
std::string advice_on(const std::string& word) {
  for (const char* option : {"--trials", "--flights", "--seeds"})
    if (word == option)
      return "The number of flights is `trials` of a campaign's file, and --max-trials of tether "
             "size.";
  if (word == "--")
    return "Only `tether run` takes a program after '--'. Other commands fly the scenario's file "
           "that it leaves in its folder, `scenario.toml`.";
  return scenario::ShippedFiles::of_program(os::own_file()).what_is(word);
}

/// Takes the words after "--" off the command line of a command that has a place for them.
struct AfterDashes {
  std::vector<std::string>* to = nullptr;
  bool has_dashes = false;

  AfterDashes(const Command& command, std::vector<std::string>& words) {
    for (const Option& row : command.options)
      if (row.allowed.follows_dashes) to = std::get<std::vector<std::string>*>(row.destination);
    const auto dashes = std::ranges::find(words, "--");
    if (to == nullptr || words.empty() || words.front() != command.words || dashes == words.end())
      return;
    has_dashes = true;
    to->assign(dashes + 1, words.end());
    words.erase(dashes, words.end());
  }
  /// The words take the place of the command's first argument.
  void require_one(const CLI::App& command) const {
    if (to == nullptr) return;
    const CLI::Option* first = nullptr;
    for (const CLI::Option* option : command.get_options())
      if (option->get_positional() && first == nullptr) first = option;
    if (!has_dashes && first->empty()) throw CLI::RequiredError(first->get_name());
    if (has_dashes && to->empty())
      throw CLI::ValidationError("nothing follows '--', where a program has to be",
                                 CLI::ExitCodes::ValidationError);
    if (has_dashes && !first->empty())
      throw CLI::ValidationError("'" + first->as<std::string>() + "' is before '--', which takes " +
                                     "the place of a " + first->get_name() + "; remove one of them",
                                 CLI::ExitCodes::ValidationError);
  }
};

/// The file of --junit also of a command line that cannot be parsed; empty: there is none.
std::string junit_in(const std::vector<std::string>& words) {
  constexpr std::string_view kOption = "--junit", kWithValue = "--junit=";
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].starts_with(kWithValue)) return words[i].substr(kWithValue.size());
    if (words[i] == kOption && i + 1 < words.size()) return words[i + 1];
  }
  return "";
}

}  // namespace

int run_command_line(int argc, char** argv, std::optional<os::Interrupt>& interrupt) {
  CLI::App program{"Tests in simulation whether a UAV's computer is fast enough for its task."};
  program.name("tether");
  program.footer(kFooter);
  program.set_version_flag("--version", std::string(version()));
  program.require_subcommand(1);
  program.formatter(help_format(os::text_columns(STDOUT_FILENO)));  // of the commands too

  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  std::function<int(const std::stop_token&)> action;
  for (const Command& command : commands()) {
    CLI::App* added =
        add_command(program, command.words, command.help, command.options, command.footer);
    const AfterDashes after(command, words);
    if (command.run)
      added->callback([&action, run = command.run, after, added] {
        after.require_one(*added);
        action = run;
      });
    else
      added->require_subcommand(1);
  }
  std::string shell;
  add_completion_command(program, shell)->callback([&] {
    action = [&](const std::stop_token&) {
      fmt::print("{}", completion_script(program, shell));
      return 0;
    };
  });
  if (const auto page = asked_manual_page(program, words)) {
    fmt::print("{}", *page);
    return 0;
  }
  try {
    program.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return program.exit(e);  // --help, --version
    const std::string why = complaint(program, e, advice_on);
    complain("tether: " + why);
    try {
      (void)with_junit(junit_in(words), "tether",
                       [&]() -> int { throw Error(ErrorCode::kUsage, why); });
    } catch (const Error&) {  // is that one, or the file cannot be written
    }
    return exit_code(ErrorCode::kUsage);
  }
  interrupt.emplace();
  return action(interrupt->token());
}

}  // namespace tether::app
