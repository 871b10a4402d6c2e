#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>

#include <fmt/format.h>

#include <tether/campaign/campaign_plan.h>
#include <tether/campaign/result.h>
#include <tether/os/clock.h>
#include <tether/workers/collect.h>
#include <tether/workers/worker.h>

// What planning, claiming, handing in and collecting cost for each trial, with trials that do
// nothing but leave the four files of a flight.
//
// usage: workers_bench FOLDER [TRIALS] [CHUNK_TASKS]
//   FOLDER       a new folder on the file system to measure
//   CHUNK_TASKS  tasks by which chunks are sized; a large number gives chunks of one trial
using namespace tether;

namespace {

struct Meter {
  const workers::SharedFolder& folder;
  std::size_t trials;
  Duration cpu = os::read_clock(CLOCK_PROCESS_CPUTIME_ID), wall = os::read_clock(CLOCK_MONOTONIC);
  std::uint64_t operations = folder.operations();

  void print(const char* what) {
    const auto ms = [&](Duration now, Duration then) {
      return 1e3 * to_seconds(now - then) / static_cast<double>(trials);
    };
    fmt::print("{:<22} {:8.4f} ms CPU {:8.4f} ms wall {:8.3f} requests\n", what,
               ms(os::read_clock(CLOCK_PROCESS_CPUTIME_ID), cpu),
               ms(os::read_clock(CLOCK_MONOTONIC), wall),
               static_cast<double>(folder.operations() - operations) / static_cast<double>(trials));
    *this = Meter{folder, trials};
  }
  Meter& operator=(const Meter& other) {
    cpu = other.cpu;
    wall = other.wall;
    operations = other.operations;
    return *this;
  }
};

/// Workers are started by hand, below.
class NoEngine final : public workers::Engine {
 public:
  bool start(const workers::Round&, const workers::Order&) override { return false; }
  std::optional<std::vector<workers::Task>> tasks(const workers::Round&) override {
    return std::vector<workers::Task>{};
  }
  void cancel(const workers::Round&) override {}
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const std::size_t trials = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 100'000;
  const std::size_t tasks = argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 1000;
  const workers::SharedFolder folder{std::filesystem::absolute(argv[1])};
  folder.make("");

  scenario::Campaign campaign;
  campaign.name = "nothing";
  scenario::Scenario scenario;
  scenario.name = "nothing";
  scenario.uavs.resize(1);
  scenario.conditions.emplace_back().name = "host";
  scenario.conditions[0].computers[0].clock.kind = computer::ClockKind::kScripted;
  for (std::uint64_t seed = 1; seed <= trials; ++seed) campaign.seeds.push_back(seed);
  campaign.scenarios = {{scenario, {"host"}, ""}};
  const auto plans = campaign::plan_trials(campaign, folder.root());
  std::vector<const campaign::TrialPlan*> wanted;
  for (const auto& plan : plans) wanted.push_back(&plan);
  auto result = campaign::make_setup_failure(*plans[0].scenario, *plans[0].condition, 1, "nothing");
  result.end = campaign::kEndFinished;
  const std::string text = campaign::to_json(result);

  NoEngine engine;
  const workers::CollectSetup setup{
      .settings = {},
      .order = {.tasks = tasks},
      .request = [](const auto& plan) { return plan.condition->name + std::to_string(plan.seed); },
      .now = [] { return os::read_clock(CLOCK_MONOTONIC); },
      .sleep = [](Duration) {}};

  Meter meter{folder, trials};
  (void)workers::collect(folder, wanted, engine, setup);
  meter.print("planning");
  const auto scratch = folder.root().string() + ".scratch";
  const auto write_files = [&](const workers::Item&, const std::filesystem::path& local, double) {
    for (const char* name : {"record.mcap", "sut-uav1.log"}) std::ofstream(local / name) << "x";
    std::ofstream(local / "run.log");  // empty if all is well
    std::ofstream(local / campaign::kResultFile) << text;
    return workers::Flight{};
  };
  const auto end = workers::work(*workers::newest_round(folder),
                                 {.self = {"w", "n", ""}, .scratch = scratch, .fly = write_files});
  meter.print("claiming, handing in");
  const auto late = workers::work(*workers::newest_round(folder),
                                  {.self = {"v", "n", ""}, .scratch = scratch, .fly = write_files});
  meter.print("a worker that is late");
  const auto collected = workers::collect(folder, wanted, engine, setup);
  meter.print("collecting");
  std::filesystem::remove_all(scratch);
  fmt::print("{} flown, {} late, {} collected\n", end.flown, late.flown, collected.outcome.ran);
  return end.flown == trials && late.flown == 0 && collected.outcome.ran == trials ? 0 : 1;
}
