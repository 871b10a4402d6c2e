#pragma once

#include "cluster/cluster.h"
#include "commands/commands.h"
#include "terminal/status_line.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/run_campaign.h>
#include <tether/report/size_report.h>
#include <tether/runner/trial_server.h>
#include <tether/scenario/campaign.h>
#include <tether/sizing/sizing.h>

namespace tether::app {

/// `tether size` gives up after so many failed flights, whatever it varies.
inline constexpr std::size_t kMostFailedFlights = 3;

/// The scenario of the options, with these values replaced.
/// @throws as load_scenario; Error(kUsage) if an option cannot be used.
scenario::Scenario load_sized_scenario(const SizeOptions& options,
                                       const std::vector<scenario::Setting>& settings = {});
campaign::OpenMode open_mode(const SizeOptions& options);
/// An answer must not be there while flights for another one are flown.
void remove_earlier_answer(const std::filesystem::path& out);

/// The flights of `tether size`: a campaign whose conditions are the slowed ones, of which only
/// those trials are run that the statistics ask for. Each flight has a seed of its own: flights
/// with the same seed succeed and fail together, and say less than their number.
class SizeFlights {
 public:
  struct Setup {
    scenario::Scenario scenario;
    /// The one to size; then, if it is wanted, the one without synchronisation.
    std::vector<scenario::Condition> conditions;
    std::size_t most = 0;
    int jobs = 1;
    ClusterOptions cluster{};
  };
  enum class End { kAnswered, kInterrupted, kFailing };

  /// Claims the folder, and checks it and all files of the scenario.
  /// @throws as CampaignFolder, scenario::slow_down and runner::files_of_trials.
  SizeFlights(const Setup& setup, const sizing::CurveGrid& grid, const ReadingOptions& reading,
              const std::filesystem::path& out, campaign::OpenMode mode, std::stop_token stop);

  /// Flies until there is an answer, from the flights that the folder already has. Fills in what of
  /// the report depends on flights.
  End fly(report::SizeReport& report);

 private:
  using Key = std::pair<std::string, std::uint64_t>;  // a slowed condition and a seed

  scenario::Campaign make_campaign() const;
  std::string slowed_name(std::size_t condition, double slowdown) const;
  bool run(const std::vector<Key>& keys);
  void take(const campaign::TrialResult& trial, double slowdown, report::SizedCondition& into,
            sizing::Sizing& sizing);
  void take_earlier();
  End fly_synchronised();
  bool fly_unsynchronised();
  void show(const campaign::CampaignProgress& progress);

  const Setup& setup_;
  const sizing::CurveGrid& grid_;
  std::stop_token stop_;
  scenario::Campaign campaign_;
  std::vector<std::filesystem::path> files_;
  campaign::Settings settings_;
  campaign::CampaignFolder folder_;
  std::map<Key, const campaign::TrialPlan*> missing_;
  runner::TrialServers servers_;
  bool has_margins_ = false;
  sizing::Sizing sizing_;
  std::uint64_t next_seed_ = 1;
  std::size_t failures_ = 0;  // of this run
  report::SizeReport* report_ = nullptr;
  StatusLine line_;
  std::optional<Cluster> cluster_;
};

}  // namespace tether::app
