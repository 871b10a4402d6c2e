#include "commands/commands.h"
#include "terminal/print.h"
#include "terminal/print_report.h"
#include "terminal/say.h"

#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/base/text.h>
#include <tether/campaign/campaign_plan.h>
#include <tether/campaign/campaign_results.h>
#include <tether/os/text_file.h>
#include <tether/report/junit.h>
#include <tether/runner/trial_folder.h>
#include <tether/shards/shard.h>

namespace tether::app {
namespace {

constexpr std::size_t kMostNames = 5;

void complain_of_each(const std::string& what, const std::vector<std::string>& lines) {
  for (const std::string& line : lines) complain(fmt::format("warning: {}: {}", what, line));
}

void say_missing(const shards::Collected& collected, const std::filesystem::path& out) {
  say("{} of {} have no result:\n", collected.missing.size(), counted(collected.planned, "trial"));
  for (std::size_t i = 0; i < collected.missing.size() && i < kMostNames; ++i)
    say("  {}\n", collected.missing[i].string());
  if (collected.missing.size() > kMostNames)
    say("  and {} more\n", collected.missing.size() - kMostNames);
  say("To fly them, type: tether campaign CAMPAIGN --out {} --resume\n", out.string());
}

/// A result is all that a report needs, but an audit, plots and pages need the record.
void complain_of_records(const campaign::CampaignResults& results,
                         const std::filesystem::path& out) {
  for (const campaign::ScenarioResults& scenario : results.scenarios)
    for (const campaign::ConditionResults& condition : scenario.conditions)
      for (const campaign::TrialResult& trial : condition.trials) {
        const std::filesystem::path folder =
            campaign::trial_folder(scenario.scenario, condition.condition, trial.seed);
        if (trial.end != campaign::kEndSetupFailed &&
            !std::filesystem::exists(out / folder / runner::kRecordFile))
          complain(fmt::format("warning: {}: its record is missing", folder.string()));
      }
}

}  // namespace

int collect_campaign(const std::vector<std::filesystem::path>& folders,
                     const std::filesystem::path& junit) {
  const std::filesystem::path& out = folders.front();
  const shards::Collected collected = shards::collect(folders);
  complain_of_each("left out", collected.left_out);
  complain_of_each("flown twice", collected.differing);
  const campaign::CampaignResults results = campaign::read_campaign_results(out);
  complain_of_records(results, out);
  if (!junit.empty()) os::write_file_atomically(junit, report::to_junit(results, out));
  print_campaign_summary(results, out);
  if (!collected.missing.empty()) say_missing(collected, out);
  if (!collected.left_out.empty()) return exit_code(ErrorCode::kBadFile);
  return collected.missing.empty() ? 0 : exit_code(ErrorCode::kSetup);
}

}  // namespace tether::app
