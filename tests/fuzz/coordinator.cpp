#include "memory_record.h"
#include "peers.h"

#include <tether/audit/audit.h>
#include <tether/coordinator/coordinator.h>
#include <tether/sim_testing/fake_simulator.h>

/// The coordinator and its barrier, with SUTs that keep or break every rule. Input: the run's
/// options, then what the SUTs do. Whatever that is, the run ends, and where it calls itself clean
/// the audit finds it clean.
namespace tether::fuzz {
namespace {

using std::chrono::milliseconds;

coordinator::RunOptions options_of(Choices& choices) {
  coordinator::RunOptions options;
  const bool is_free = choices.below(4) == 3;
  if (is_free) options.policy = sync::SyncPolicy::kFreeRunning;
  options.real_time_factor = is_free ? 1.0 : 0.0;
  options.token = "secret";
  options.time_limit = milliseconds(1 + choices.byte() * 4);
  options.ground_truth_period = milliseconds(1 + choices.byte());
  options.record_images = choices.coin();
  const uav::PeriodicTiming camera{milliseconds(33), Duration(0),
                                   uav::ConstantDelay{milliseconds(choices.byte())}};
  const uav::PeriodicTiming imu{milliseconds(5), Duration(choices.number() & 0xfffff),
                                uav::NormalDelay{milliseconds(2), milliseconds(1)}};
  const uav::OnDemandTiming range{uav::ConstantDelay{std::chrono::microseconds(97'700)}};
  const Duration latency = milliseconds(choices.byte() % 4 * 3);
  coordinator::UavOptions uav;
  uav.timings = {camera, imu, range};
  uav.command_latency = uav::ConstantDelay{latency};
  options.uavs.assign(1 + choices.below(3), uav);
  return options;
}

void require_honest(const coordinator::RunReport& report, const record::Record& record,
                    bool is_tied) {
  require_one_line(report.reason);
  require(report.st >= SimTime{}, "a negative ST");
  for (const coordinator::SutReport& sut : report.suts) {
    if (!sut.sut.empty()) require_one_line(sut.sut);
    if (sut.finish) require_one_line(sut.finish->outcome);
  }
  if (!report.began) return;
  require(record.footer.has_value(), "a run that began without a record's end");
  const audit::Verdict verdict = audit::audit(record);
  require(verdict.complete && verdict.synchronised == is_tied, "the audit reads another run");
  if (report.causality_violations > 0 || verdict.findings.empty()) return;
  require(false, "a run that calls itself clean: " + audit::to_text(verdict));
}

}  // namespace
}  // namespace tether::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  fuzz::Choices choices({data, size});
  const coordinator::RunOptions options = fuzz::options_of(choices);
  sim::FakeSimulator simulator(sim::make_fake_world(options.uavs.size()));
  fuzz::MemoryRecord recorder;
  fuzz::Peers peers(choices);
  WallTime now{};
  coordinator::Coordinator coordinator(simulator, recorder, options, [&] {
    now += std::chrono::microseconds(100);
    return now + peers.passed;
  });
  const coordinator::RunReport report = coordinator.run(peers);
  fuzz::require_honest(report, recorder.take(),
                       options.policy == sync::SyncPolicy::kConservativeBarrier);
  return 0;
}
