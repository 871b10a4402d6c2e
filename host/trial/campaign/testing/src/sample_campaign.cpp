#include <tether/campaign_testing/sample_campaign.h>

namespace tether::campaign {
namespace {

using scenario::Policy;

scenario::Condition on_cpu(const char* name, Policy policy, double factor,
                           double real_time_factor) {
  scenario::Condition condition;
  condition.name = name;
  condition.policy = policy;
  condition.real_time_factor = real_time_factor;
  condition.computers[0].clock = {computer::ClockKind::kCpu, factor};
  return condition;
}

}  // namespace

scenario::Campaign make_campaign(const ScratchFolder& scratch) {
  scenario::Scenario s;
  s.file = scratch.write("in/turn.toml", "the scenario");
  s.world = scratch.write("in/room.sdf", "the world");
  s.files = {s.world, s.file};
  s.name = "turn";
  s.description = "turn to the box";
  s.uavs.resize(1);
  s.conditions = {on_cpu("host", Policy::kConservativeBarrier, 1.0, 0.0),
                  on_cpu("target", Policy::kConservativeBarrier, 8.0, 0.0),
                  on_cpu("target, no sync", Policy::kFreeRunning, 8.0, 0.25)};
  s.metrics = {{"oscillations", "oscillations", "Oscillations", "1", "uav1", "box", 0.02, {}},
               {"time_required", "time_required", "Time required", "s", "uav1", "", 0.0, 30.0}};
  scenario::Campaign campaign;
  campaign.file = scratch.path("in/campaign.toml");
  campaign.name = "study";
  campaign.description = "a study";
  campaign.seeds = {1, 2, 3};
  campaign.scenarios = {{s, {"host", "target", "target, no sync"}, "III"}};
  return campaign;
}

TrialResult make_trial(const scenario::Scenario& scenario, const std::string& condition,
                       std::uint64_t seed, double oscillations, double time_required_s) {
  TrialResult result = make_setup_failure(scenario, *scenario.find_condition(condition), seed, "");
  result.outcome = Outcome::kGoalReached;
  result.end = kEndFinished;
  result.reason = "every SUT reached its goal within the limits";
  result.metrics[0].value = oscillations;
  result.metrics[1].value = time_required_s;
  for (MetricValue& metric : result.metrics) metric.missing_because = "";
  result.suts = {{"uav1",
                  "tether-sut 0.1.0",
                  {computer::ClockKind::kCpu, 8.0},
                  ExecTime(std::chrono::seconds(3)),
                  true,
                  true,
                  "the anchor is in the middle",
                  R"({"steps":12})"}};
  result.sync = {120, 0, Duration(999'999), SimTime(Duration(2'481'000'001))};
  const SimTime early(Duration(1'000'000'001));
  result.contacts = {{"uav1", 2, 0, record::Contact{"uav1", early, "room", 0.25},
                      record::Clearance{"uav1", 0.5, early, "shelf"}}};
  result.audit = AuditVerdict{true, "no violation"};
  result.versions = {{"simulator", "mujoco 2.2.2"}, {"tether", "0.1.0"}};
  result.this_run = {"2024-05-01T10:00:00Z", "a machine", Duration(1'234'567'891),
                     Duration(36'000'000),   1,           ""};
  return result;
}

}  // namespace tether::campaign
