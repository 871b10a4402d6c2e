#pragma once

#include "commands/size_options.h"
#include "terminal/status_line.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/run_campaign.h>
#include <tether/report/plots.h>
#include <tether/report/verdict.h>
#include <tether/runner/trial_server.h>
#include <tether/scenario/campaign.h>
#include <tether/shards/engine.h>

/// What `tether size` does alike whatever it varies.
namespace tether::app {

/// The scenario of the options, with these values replaced.
/// @throws as load_scenario; Error(kBadFile) if no limit decides; Error(kUsage) if an option cannot
///   be used.
scenario::Scenario load_sized_scenario(const SizeOptions& options,
                                       const std::vector<scenario::Setting>& settings = {});

/// @param miss how likely an interval that ends at 100 % is wrong
/// @throws Error(kUsage) if --max-trials cannot show the share even if all flights succeed.
void require_enough_trials(const SizeOptions& options, double miss);

/// A campaign of which only those trials are run that an answer needs. Each flight has a seed of
/// its own: flights with the same seed succeed and fail together, and say less than their number.
class SizeTrials {
 public:
  enum class End { kAnswered, kInterrupted, kFailing, kUndecidable };
  /// A trial of the campaign, but for its seed.
  struct Wanted {
    std::string scenario, condition;
  };
  struct Questions {
    /// The next flights, at most so many; none: there is an answer, or 0 were allowed.
    std::function<std::vector<Wanted>(std::size_t most)> next;
    std::function<void(const campaign::TrialPlan&, const campaign::TrialResult&)> take;
    std::function<std::string()> so_far;  ///< for the line that shows progress
  };

  /// Claims the folder, and checks it and all files of the campaign. Removes an earlier answer: it
  /// must not be there while flights for another one are flown.
  /// @param name what varies in a trial, such as "2 UAVs"
  /// @throws as CampaignFolder and runner::files_of_trials; Error(kUsage) about an option.
  SizeTrials(const SizeOptions& options, scenario::Campaign campaign,
             const std::filesystem::path& out, std::stop_token stop,
             std::function<std::string(const campaign::TrialPlan&)> name);

  const campaign::Settings& settings() const { return settings_; }
  /// Takes the flights that the folder had, in the order of `plan_trials`, then flies until there
  /// is an answer. @param is_asked whether the answer rests on such trials
  End fly(const Questions& questions,
          const std::function<bool(const campaign::TrialPlan&)>& is_asked);
  /// Flies these too, if they are missing, and takes all of them. False: interrupted.
  bool fly_also(const std::vector<std::pair<Wanted, std::uint64_t>>& trials,
                const Questions& questions);
  /// One line for each flight that failed, which says nothing about the computer.
  const std::vector<std::string>& not_flown() const { return not_flown_; }
  /// For a call that ends without an answer: says why, and how to go on. @return the exit code.
  int say_why(End end) const;

 private:
  using Plans = std::vector<const campaign::TrialPlan*>;

  std::vector<std::filesystem::path> checked_files(const std::filesystem::path& out);
  std::string text_of(const campaign::TrialPlan& plan) const;
  bool run(const Plans& plans, const Questions& questions);
  void take(const campaign::TrialPlan& plan, const Questions& questions);
  void show(const campaign::CampaignProgress& progress, const Questions& questions);

  const SizeOptions& options_;
  scenario::Campaign campaign_;
  std::optional<shards::Engine> engine_;
  int jobs_;
  std::stop_token stop_;
  std::function<std::string(const campaign::TrialPlan&)> name_;
  // Before the folder: copies of this process must not hold its locks.
  runner::TrialServers servers_;
  std::vector<std::filesystem::path> files_;
  campaign::Settings settings_;
  campaign::CampaignFolder folder_;
  std::map<std::filesystem::path, const campaign::TrialPlan*> missing_;  // by its folder
  StatusLine line_;
  std::uint64_t next_seed_ = 1;
  std::size_t flown_ = 0;
  // Flights that missed a limit only because its metric has no value, and the reason of the first.
  std::size_t without_value_ = 0;
  std::string why_without_value_;
  std::vector<std::string> not_flown_;
};

/// What `tether size` prints and writes.
struct SizeAnswer {
  std::vector<report::Answer> answers;
  std::vector<std::string> advice;
  std::string json;
  report::Plot plot;
  std::string page;
  std::string junit;
};
/// @param junit the file for JUnit's form of it; empty: none
void write_answer(const SizeAnswer& answer, const std::filesystem::path& out,
                  const std::filesystem::path& junit);

}  // namespace tether::app
