#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/base/random.h>
#include <tether/campaign/campaign_plan.h>
#include <tether/os/text_file.h>

// The order of a campaign's trials, which of them may run in parallel, and the settings that must
// be the same for all of them.
namespace tether::campaign {
namespace {

// Such as the script of ["python3", "sut.py"]. The program itself is found as all programs are.
void add_argument_files(std::vector<std::filesystem::path>& files, const scenario::Sut& sut) {
  for (std::size_t i = 1; i < sut.command.size(); ++i) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(sut.command[i], ignored)) continue;
    files.push_back(std::filesystem::absolute(sut.command[i]));
  }
}

std::string name_in(const scenario::Campaign& campaign, const std::filesystem::path& file) {
  return file.lexically_proximate(campaign.file.parent_path()).string();
}

// An external simulator that is given by its address, which serves one run at a time.
bool is_attached(const std::string& simulator) {
  return simulator != "mujoco" && simulator != "gazebo";
}

[[noreturn]] void refuse_jobs(int jobs, const std::string& why) {
  throw Error(ErrorCode::kUsage, fmt::format("--jobs {}: {}", jobs, why)).about("--jobs");
}

std::string setting_name(const scenario::Campaign& campaign, const std::filesystem::path& file) {
  return std::string(kFileSetting) + name_in(campaign, file);
}

}  // namespace

std::filesystem::path trial_folder(const std::string& scenario, const std::string& condition,
                                   std::uint64_t seed) {
  return std::filesystem::path(scenario) / scenario::slug(condition) /
         fmt::format("seed-{:04}", seed);
}

std::vector<TrialPlan> plan_trials(const scenario::Campaign& campaign,
                                   const std::filesystem::path& folder) {
  std::vector<TrialPlan> plans;
  for (const scenario::CampaignScenario& entry : campaign.scenarios) {
    for (const std::uint64_t seed : campaign.seeds) {
      for (const std::string& condition : entry.conditions) {
        plans.push_back({&entry.scenario, entry.scenario.find_condition(condition), seed,
                         folder / trial_folder(entry.scenario.name, condition, seed),
                         campaign.images_of_first_seed && seed == campaign.seeds.front(),
                         entry.profile});
      }
    }
  }
  return plans;
}

std::vector<const TrialPlan*> in_order_of_flight(std::vector<const TrialPlan*> plans) {
  const auto place = [](const TrialPlan* plan) {
    const std::uint64_t stream =
        random_stream(plan->scenario->name, plan->condition->name, "order of flight");
    return KeyedRandom({plan->seed, stream, 0}).bits();
  };
  for (auto first = plans.begin(), last = first; first != plans.end(); first = last) {
    last = std::find_if(first, plans.end(), [&](const TrialPlan* plan) {
      return plan->seed != (*first)->seed || plan->scenario->name != (*first)->scenario->name;
    });
    std::stable_sort(first, last, [&](const TrialPlan* one, const TrialPlan* other) {
      return place(one) < place(other);
    });
  }
  return plans;
}

bool repeats(const scenario::Condition& condition) {
  return condition.policy == scenario::Policy::kConservativeBarrier &&
         std::ranges::all_of(condition.computers, [](const scenario::Computer& computer) {
           return computer.clock.repeats();
         });
}

int parallel_trials(const TrialPlan& plan, int jobs) {
  constexpr double kSimulatorLoad = 0.5, kShareInUse = 0.5;
  const scenario::Condition& condition = *plan.condition;
  // Parallel trials would distort the times of SUTs with a wall clock, and be bound to the same
  // cores.
  double load_of_suts = 0.0;
  for (std::size_t uav = 0; uav < plan.scenario->uavs.size(); ++uav) {
    const scenario::Computer& own = computer_of(condition, uav);
    const bool is_bound = own.target && own.target->cores > 0;
    const auto& controller = plan.scenario->uavs[uav].flight_controller;
    const bool has_ports = controller && controller->has_fixed_ports;
    if (own.clock.counts_waiting() || is_bound || has_ports) return 1;
    load_of_suts += 1.0 / own.clock.factor + kSimulatorLoad * condition.real_time_factor;
  }
  if (jobs == 1) return 1;
  if (condition.policy == scenario::Policy::kConservativeBarrier) return jobs;
  if (condition.simulator != "mujoco") return 1;
  // A stalling SUT computes for one part in its factor of the time; the embedded simulator with
  // its camera took up to half a core at real time.
  return std::max(1, static_cast<int>(kShareInUse * jobs / load_of_suts));
}

std::vector<Batch> make_batches(const std::vector<const TrialPlan*>& plans, int jobs) {
  std::map<std::pair<bool, int>, Batch> batches;
  for (const TrialPlan* plan : plans) {
    const int parallel = parallel_trials(*plan, jobs);
    const bool is_free = plan->condition->policy == scenario::Policy::kFreeRunning;
    Batch& batch = batches[{is_free, parallel}];
    batch.jobs = parallel;
    batch.plans.push_back(plan);
  }
  std::vector<Batch> in_order;
  for (auto& [key, batch] : batches) in_order.push_back(std::move(batch));
  return in_order;
}

void require_jobs_allowed(const scenario::Campaign& campaign, int jobs) {
  if (jobs < 1) refuse_jobs(jobs, "must be at least 1.");
  if (jobs == 1) return;
  for (const scenario::CampaignScenario& entry : campaign.scenarios) {
    for (const std::string& name : entry.conditions) {
      const scenario::Condition& condition = *entry.scenario.find_condition(name);
      const std::string where =
          fmt::format("condition '{}' of {}", name, entry.scenario.file.string());
      if (is_attached(condition.simulator))
        refuse_jobs(jobs, fmt::format("{} uses the simulator at {}, which serves one run at a "
                                      "time. Use --jobs 1.",
                                      where, condition.simulator));
      bool has_wall_clock = false;
      for (std::size_t uav = 0; uav < entry.scenario.uavs.size(); ++uav)
        has_wall_clock = has_wall_clock || computer_of(condition, uav).clock.counts_waiting();
      if (has_wall_clock)
        refuse_jobs(jobs, fmt::format("{} measures its SUT by the wall clock, which parallel "
                                      "trials would distort. Use --jobs 1, or clock = \"cpu\" or "
                                      "\"scripted\".",
                                      where));
    }
  }
}

std::vector<std::filesystem::path> files_of(const scenario::Campaign& campaign) {
  std::vector<std::filesystem::path> files;
  for (const scenario::CampaignScenario& entry : campaign.scenarios) {
    const scenario::Scenario& scenario = entry.scenario;
    files.insert(files.end(), scenario.files.begin(), scenario.files.end());
    for (const scenario::UavSetup& uav : scenario.uavs) add_argument_files(files, uav.sut);
  }
  return files;
}

Settings campaign_settings(const scenario::Campaign& campaign, const Settings& versions,
                           const std::vector<std::filesystem::path>& files) {
  Settings settings = versions;
  for (const std::filesystem::path& file : files) {
    settings[setting_name(campaign, file)] = os::digest_of_file(file);
  }
  for (const scenario::CampaignScenario& entry : campaign.scenarios) {
    if (entry.profile.empty()) continue;
    settings["profile of " + entry.scenario.name] = name_in(campaign, entry.profile);
  }
  return settings;
}

void require_unchanged(const scenario::Campaign& campaign, const Settings& settings,
                       const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& file : files) {
    std::error_code ignored;
    const bool exists = std::filesystem::is_regular_file(file, ignored);
    if (exists && os::digest_of_file(file) == settings.at(setting_name(campaign, file))) continue;
    throw Error(ErrorCode::kBadFile, {file.string()},
                fmt::format("was {} while the campaign ran, so the trial that has just ended is "
                            "not kept. Restore the file and continue with --resume, or choose "
                            "another folder.",
                            exists ? "changed" : "removed"))
        .about(file.string());
  }
}

}  // namespace tether::campaign
