#include "back_ends.h"
#include "commands/commands.h"
#include "options/junit_option.h"
#include "reading/file_kind.h"
#include "reading/world_options.h"
#include "terminal/print.h"
#include "terminal/say.h"
#include "terminal/status_line.h"

#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include <tether/campaign/result.h>
#include <tether/os/program.h>
#include <tether/os/terminal.h>
#include <tether/os/text_file.h>
#include <tether/report/junit.h>
#include <tether/report/page.h>
#include <tether/report/run_text.h>
#include <tether/runner/trial.h>
#include <tether/runner/trial_folder.h>
#include <tether/runner/trial_request.h>
#include <tether/scenario/scenario.h>
#include <tether/scenario/shipped_files.h>

/// `tether run`: makes a request of the options, runs its trial with the status on stderr, and
/// prints the result.
namespace tether::app {

namespace {

/// The file that the user means, which is not of another kind.
std::filesystem::path find_file(const scenario::ShippedFiles& shipped, scenario::ShippedKind kind,
                                const std::filesystem::path& given, FileKind wanted) {
  const std::filesystem::path file = shipped.find(kind, given);
  require_kind(file, wanted);
  return file;
}

runner::TrialRequest make_request(const RunOptions& options) {
  const auto shipped = scenario::ShippedFiles::of_program(os::own_file());
  const auto find = [&](scenario::ShippedKind kind, const std::filesystem::path& given,
                        FileKind wanted) {
    return std::filesystem::absolute(find_file(shipped, kind, given, wanted));
  };
  runner::TrialRequest request = options.request;
  request.scenario = find(scenario::ShippedKind::kScenario, options.scenario, FileKind::kScenario);
  for (const std::string& text : options.settings)
    request.settings.push_back(scenario::parse_setting(text, std::filesystem::current_path()));
  request.reading = world_options(options.reading, shipped);
  if (!options.profile.empty())
    request.profile = find(scenario::ShippedKind::kProfile, options.profile, FileKind::kProfile);
  request.target = runner::parse_target_choice(options.target);
  if (auto* file = std::get_if<std::filesystem::path>(&request.target))
    *file = find(scenario::ShippedKind::kTarget, *file, FileKind::kTarget);
  return request;
}

int run_and_print(const RunOptions& options, const std::stop_token& stop) {
  const runner::TrialSpec spec = runner::make_trial(make_request(options));
  campaign::TrialResult result;
  {
    StatusLine line;
    runner::TrialObserver observer;
    if (!options.quiet) {
      observer.warn = [&](const std::string& text) { line.print("warning: " + text); };
      observer.on_warnings = [&](const std::vector<Warning>& warnings) {
        line.print(summary_of(warnings, (spec.folder / runner::kWarningsFile).string()));
      };
      observer.on_status = [&](const coordinator::RunStatus& status) { line.show(status); };
      observer.on_setup = [&](const std::string& text) { line.show(text); };
      observer.on_blocked = [&](const std::string& text) { line.print(text); };
    }
    observer.on_refused = [](const std::string& text) { complain("warning: " + text); };
    observer.on_listening = [](const std::string& text) {
      say("Waiting for the SUT to connect. Start it with:\n{}", text);
    };
    result = runner::run_trial(spec, find_back_end, observer, stop);
  }
  if (!options.junit.empty())
    os::write_file_atomically(options.junit,
                              report::to_junit(report::results_of_run(result), spec.folder));
  if (options.json)
    fmt::print("{}\n", campaign::to_json(result));
  else if (!options.quiet)
    print(report::run_text(result, spec.folder, markup_of_stdout()));
  // A person has read the reason on the same terminal.
  const bool is_read = !options.json && !options.quiet && os::terminal_columns(STDOUT_FILENO) > 0 &&
                       os::terminal_columns(STDERR_FILENO) > 0;
  if (result.outcome == campaign::Outcome::kFailed && !is_read)
    complain("tether: " + result.reason);
  return campaign::exit_code(result);
}

}  // namespace

int run_one(const RunOptions& options, const std::stop_token& stop) {
  return with_junit(options.junit, options.scenario.string(),
                    [&] { return run_and_print(options, stop); });
}

}  // namespace tether::app
