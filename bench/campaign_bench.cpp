#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/run_campaign.h>
#include <tether/runner/campaign_trials.h>
#include <tether/runner/trial_server.h>
#include <tether/scenario/campaign.h>
#include <tether/sim_sdf/load_world.h>

// What a campaign costs besides its trials: trials that compute for 1.5 s and do not fly, run as
// `tether campaign` runs them (folder, digests, servers, the world in memory, results). Yardstick:
// processes that only compute as long, as many at once. CPU time is that of all processes, and does
// not depend much on what else the machine does; wall time does.
//   campaign_bench [TRIALS]
namespace {

using namespace tether;
using Seconds = std::chrono::duration<double>;

constexpr double kTrial_s = 1.5;

double own_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void compute() {
  for (const double end = own_cpu_s() + kTrial_s; own_cpu_s() < end;) {
  }
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// CPU time of this process and of its children that have ended.
double all_cpu_s() {
  double sum = 0.0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    sum += seconds(usage.ru_utime) + seconds(usage.ru_stime);
  }
  return sum;
}

struct Cost {
  double wall_s = 0.0, cpu_s = 0.0;
};

template <class Run>
Cost cost_of(Run run) {
  const auto start = std::chrono::steady_clock::now();
  const double cpu_s = all_cpu_s();
  run();
  return {Seconds(std::chrono::steady_clock::now() - start).count(), all_cpu_s() - cpu_s};
}

/// @pre `count` is a multiple of `jobs`.
void run_yardstick(int count, int jobs) {
  for (int job = 0; job < jobs; ++job) {
    if (fork() != 0) continue;
    for (int i = 0; i < count / jobs; ++i) {
      if (fork() == 0) {
        compute();
        _exit(0);
      }
      wait(nullptr);
    }
    _exit(0);
  }
  while (wait(nullptr) > 0) {
  }
}

scenario::Campaign campaign_of(int trials) {
  scenario::Campaign campaign = scenario::load_campaign(std::filesystem::path(TETHER_SOURCE_DIR) /
                                                        "data/campaigns/face_anchor.toml");
  auto& entry = campaign.scenarios.front();
  entry.conditions = {"host"};
  campaign.scenarios.resize(1);
  for (auto& uav : entry.scenario.uavs) uav.sut.command = {"sh"};
  campaign.seeds.clear();
  for (int seed = 1; seed <= trials; ++seed)
    campaign.seeds.push_back(static_cast<std::uint64_t>(seed));
  return campaign;
}

runner::BackEnd no_back_end(const std::string&) {
  return {.prepare = [](const sim::World&, const sim::WarningSink&) { return nullptr; },
          .files = [] { return std::vector<std::filesystem::path>{}; }};
}

runner::TrialService trial_service(sim::WorldStore& worlds) {
  const auto scenario =
      std::make_shared<scenario::Scenario>(campaign_of(1).scenarios.front().scenario);
  return {.prepare =
              [scenario, &worlds](const runner::TrialRequest&) {
                worlds.load(scenario::world_request(*scenario, 1), nullptr);
              },
          .run =
              [scenario](const runner::TrialRequest& request) {
                compute();
                auto result = campaign::make_setup_failure(
                    *scenario, *scenario->find_condition("host"), request.seed, "computed");
                result.end = "finished";
                result.outcome = campaign::Outcome::kGoalReached;
                campaign::write_result(request.folder, result);
                return 0;
              }};
}

void run_campaign(const std::filesystem::path& out, int trials, int jobs) {
  const scenario::Campaign campaign = campaign_of(trials);
  sim::WorldStore worlds;
  const auto files = runner::files_of_trials(campaign, no_back_end, worlds).files;
  runner::TrialServers servers;
  servers.start(jobs, trial_service(worlds));
  const auto settings = campaign::campaign_settings(campaign, {}, files);
  const campaign::CampaignFolder folder(out, campaign, settings, campaign::OpenMode::kFresh);
  const auto outcome = campaign::run_campaign(
      folder, campaign, [&](const campaign::TrialPlan& plan) { return servers.run(plan, {}); },
      {.jobs = jobs,
       .stop = {},
       .wall = {},
       .check = [&] { campaign::require_unchanged(campaign, settings, files); }},
      {});
  if (outcome.failed > 0) throw Error(ErrorCode::kSetup, "a trial failed; see " + out.string());
}

}  // namespace

int main(int count, char** words) {
  const int trials = count > 1 ? std::atoi(words[1]) : 40;
  const auto scratch =
      std::filesystem::temp_directory_path() / fmt::format("campaign_bench-{}", getpid());
  fmt::print(
      "| {} trials of {} s | trials per minute | of the yardstick's | CPU time besides, per trial "
      "| "
      "after the start |\n|:--|--:|--:|--:|--:|\n",
      trials, kTrial_s);
  double one_job = 0.0;
  for (const int jobs : {1, 2}) {
    const Cost yardstick = cost_of([&] { run_yardstick(trials, jobs); });
    // The start (reading the world in each process) is that of a campaign with a trial per job.
    const Cost start = cost_of([&] { run_campaign(scratch / "start", jobs, jobs); });
    const Cost all = cost_of([&] { run_campaign(scratch / "all", trials, jobs); });
    std::filesystem::remove_all(scratch);
    const double per_minute = 60.0 * trials / all.wall_s;
    if (jobs == 1) one_job = per_minute;
    fmt::print(
        "| {} job{} | {:.1f}{} | {:.1f} % | {:.1f} % | {:.1f} % |\n", jobs, jobs == 1 ? "" : "s",
        per_minute, jobs == 1 ? "" : fmt::format(" ({:.2f} ×)", per_minute / one_job),
        100.0 * yardstick.wall_s / all.wall_s, 100.0 * (all.cpu_s / trials - kTrial_s) / kTrial_s,
        100.0 * ((all.cpu_s - start.cpu_s) / (trials - jobs) - kTrial_s) / kTrial_s);
    std::fflush(stdout);
  }
}
