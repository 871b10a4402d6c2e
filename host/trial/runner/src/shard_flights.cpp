#include <list>
#include <map>
#include <vector>

#include <tether/base/error.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/os/machine.h>
#include <tether/os/text_file.h>
#include <tether/runner/trial.h>
#include <tether/runner/trial_request.h>
#include <tether/runner/trial_server.h>
#include <tether/shards/shard.h>

namespace tether::runner {
namespace {

namespace fs = std::filesystem;

/// A trial of the shard, in a folder of this machine.
struct Flight {
  TrialRequest request;
  TrialSpec spec;  ///< to which `plan` points
  campaign::TrialPlan plan;
  fs::path belongs;  ///< relative to the campaign's folder
};

std::list<Flight> flights_of(const shards::TrialList& list, const fs::path& campaign,
                             const shards::Shard& shard, const fs::path& scratch) {
  std::list<Flight> flights;
  const std::vector<std::size_t> seeds = shards::seed_numbers(list.trials);
  for (std::size_t i = 0; i < list.trials.size(); ++i) {
    if (!shard.takes(seeds[i]) || campaign::has_result(campaign / list.trials[i].folder)) continue;
    Flight& flight = flights.emplace_back();
    flight.request = parse_trial_request(list.trials[i].request);
    flight.request.folder = scratch / std::to_string(i);
    flight.spec = make_trial(flight.request);
    flight.plan = {&flight.spec.scenario, &flight.spec.condition, flight.spec.seed,
                   flight.request.folder};
    flight.belongs = list.trials[i].folder;
  }
  return flights;
}

}  // namespace

campaign::CampaignOutcome fly_shard(const shards::TrialList& list, const fs::path& campaign,
                                    const shards::Shard& shard, int jobs, TrialServers& servers,
                                    const std::stop_token& stop,
                                    const campaign::ProgressCallback& progress) {
  shards::require_same_files(list.files);
  if (list.measures) shards::require_same_machine(campaign, os::describe_machine());
  const os::TemporaryFolder scratch("tether-shard-");
  std::list<Flight> flights = flights_of(list, campaign, shard, scratch.path());
  std::map<const campaign::TrialPlan*, const Flight*> by_plan;
  std::vector<const campaign::TrialPlan*> plans;
  for (const Flight& flight : flights) {
    by_plan[&flight.plan] = &flight;
    plans.push_back(&flight.plan);
  }
  const auto execute = [&](const campaign::TrialPlan& plan) {
    const Flight& flight = *by_plan.at(&plan);
    if (auto result = servers.run(flight.request, stop)) return std::move(*result);
    return interrupted(plan);
  };
  const auto keep = [&](const campaign::CampaignProgress& now) {
    if (now.result != nullptr) {
      (void)shards::hand_in(now.latest->folder, campaign, by_plan.at(now.latest)->belongs);
      std::error_code ignored;
      fs::remove_all(now.latest->folder, ignored);
    }
    if (progress) progress(now);
  };
  return campaign::run_trials(plans, execute,
                              {.jobs = jobs,
                               .stop = stop,
                               .wall = {},
                               .check = [&] { shards::require_same_files(list.files); }},
                              keep);
}

}  // namespace tether::runner
