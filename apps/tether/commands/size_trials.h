#pragma once

#include "commands/size_axis.h"
#include "terminal/status_line.h"

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/campaign/run_campaign.h>
#include <tether/runner/trial_server.h>
#include <tether/shards/engine_flights.h>

namespace tether::app {

/// The flights of `tether size`, whatever it varies, in their folder.
class SizeTrials {
 public:
  /// Claims the folder, and checks it and all files of the campaign. Removes an earlier answer: it
  /// must not be there while flights for another one are flown.
  /// @throws as CampaignFolder and runner::files_of_trials; Error(kUsage) about an option.
  /// @pre the arguments outlive the object.
  SizeTrials(const SizeOptions& options, SizeAxis& axis, const std::filesystem::path& out,
             std::stop_token stop);

  const campaign::Settings& settings() const { return settings_; }
  /// Takes the flights that the folder had, in the order of `plan_trials`, then flies until there
  /// is an answer, and what the axis wants beside it.
  sizing::SearchEnd fly();
  /// Flights that did not fail.
  std::size_t flown() const { return flown_; }
  /// One line for each flight that failed, which says nothing about the computer.
  const std::vector<std::string>& not_flown() const { return not_flown_; }
  /// For a call that ends without an answer: says why, and how to go on. @return the exit code.
  int say_why(sizing::SearchEnd end) const;

 private:
  std::vector<std::filesystem::path> checked_files(const std::filesystem::path& out);
  std::string text_of(const campaign::TrialPlan& plan) const;
  const campaign::TrialPlan& plan_of(const sizing::Wanted& wanted) const;
  bool run(std::span<const sizing::Wanted> flights);  // what is missing of them. False: interrupted
  sizing::Flown take(const sizing::Wanted& wanted);
  void show(const campaign::CampaignProgress& progress);
  // "; perhaps 40 more, 3 min" or "", from the flights of this call, for the progress only.
  std::string left(std::size_t of_this_batch) const;

  const SizeOptions& options_;
  SizeAxis& axis_;
  const scenario::Campaign& campaign_;
  std::optional<shards::Engine> engine_;
  int jobs_;
  std::stop_token stop_;
  // Before the folder: copies of this process must not hold its locks.
  runner::TrialServers servers_;
  std::vector<std::filesystem::path> files_;
  campaign::Settings settings_;
  campaign::CampaignFolder folder_;
  std::map<std::filesystem::path, const campaign::TrialPlan*> missing_;  // by its folder
  StatusLine line_;
  std::size_t flown_ = 0;
  std::size_t flown_here_ = 0;  // in this call, failed ones too
  std::chrono::steady_clock::time_point start_{};
  // Why the first flight that missed a limit for want of a value has none.
  std::string why_without_value_;
  std::vector<std::string> not_flown_;
};

}  // namespace tether::app
