#include "scripted_coordinator.h"
#include "vehicle/progress_reporter.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include <gtest/gtest.h>
#include <poll.h>

#include <tether/base/random.h>
#include <tether/client/simulated_vehicle.h>
#include <tether/client_testing/manual_time_source.h>

namespace tether::client {
namespace {

using namespace std::chrono_literals;
using client_testing::ManualTimeSource;
using link::Progress;
using link::Request;

std::unique_ptr<Vehicle> connect_with(ScriptedCoordinator& coordinator,
                                      const ManualTimeSource& source) {
  ConnectOptions options;
  options.time = std::make_unique<ManualTimeSource>(source);
  options.progress_period = 20us;
  return connect(coordinator.connect(), std::move(options)).value();
}

bool wait_for_progress(ScriptedCoordinator& coordinator, ExecTime reached) {
  return coordinator.wait_for([reached](const link::Message& message) {
    const auto* progress = std::get_if<Progress>(&message);
    return progress != nullptr && progress->reached >= reached;
  });
}

/// In the order in which the coordinator heard them, no stamp is less than one before it: progress
/// is monotone, never beyond the next request, and never about the time before the last reply.
void expect_monotone(const std::vector<link::Message>& heard) {
  ExecTime last{};
  for (const auto& message : heard) {
    std::optional<ExecTime> stamp;
    if (const auto* progress = std::get_if<Progress>(&message)) stamp = progress->reached;
    if (const auto* request = std::get_if<Request>(&message)) stamp = request->issued_at;
    if (const auto* annotation = std::get_if<link::Annotation>(&message)) stamp = annotation->at;
    if (!stamp) continue;
    ASSERT_GE(*stamp, last);
    last = *stamp;
  }
}

TEST(Progress, ReportsEtWhileComputing) {
  ManualTimeSource source(computer::ClockKind::kWall);
  ScriptedCoordinator coordinator(link::Welcome{});
  const auto vehicle = connect_with(coordinator, source);
  for (int i = 1; i <= 50; ++i) {
    source.advance(5ms);
    ASSERT_TRUE(wait_for_progress(coordinator, ExecTime(i * 5ms)));
    ASSERT_TRUE(vehicle->command_velocity({}).ok());
  }
  expect_monotone(coordinator.heard());
}

TEST(Progress, IsMonotoneBetweenRequests) {
  ManualTimeSource source(computer::ClockKind::kWall);
  ScriptedCoordinator coordinator(link::Welcome{}, [](const Request& r) {
    return std::vector<link::Message>{link::Reply{r.sequence, r.issued_at + 7us, {}}};
  });
  {
    const auto vehicle = connect_with(coordinator, source);
    KeyedRandom random({9, 1, 0});
    for (int i = 0; i < 3000; ++i) {
      for (std::uint32_t k = random.bits() % 20; k > 0; --k)
        source.advance(Duration(random.bits() % 1000));
      if (i % 5 == 0) {
        ASSERT_TRUE(vehicle->annotate("task", "{}").ok());
      }
      ASSERT_TRUE(vehicle->command_velocity({}).ok());
    }
  }
  coordinator.wait_for_end();
  expect_monotone(coordinator.heard());
}

TEST(Progress, IsNotSentWhileAReplyIsPending) {
  ManualTimeSource source(computer::ClockKind::kWall);
  ScriptedCoordinator coordinator(link::Welcome{}, [&source](const Request& r) {
    for (int i = 0; i < 20; ++i) {
      source.advance(1ms);
      ::poll(nullptr, 0, 1);  // many periods of the reporter
    }
    return std::vector<link::Message>{link::Reply{r.sequence, r.issued_at + 1h, {}}};
  });
  {
    const auto vehicle = connect_with(coordinator, source);
    ASSERT_TRUE(vehicle->command_velocity({}).ok());
  }
  coordinator.wait_for_end();
  const ExecTime resumed = coordinator.requests().at(0).issued_at + 1h;
  const auto heard = coordinator.heard();
  auto message = std::find_if(heard.begin(), heard.end(), [](const link::Message& m) {
    return std::holds_alternative<Request>(m);
  });
  for (; message != heard.end(); ++message) {
    const auto* progress = std::get_if<Progress>(&*message);
    EXPECT_TRUE(progress == nullptr || progress->reached >= resumed);
  }
}

// ---- signs of life in free running

link::Welcome free_running() {
  link::Welcome welcome;
  welcome.free_running = true;
  return welcome;
}

std::size_t count_progress(const std::vector<link::Message>& heard) {
  return static_cast<std::size_t>(
      std::count_if(heard.begin(), heard.end(),
                    [](const auto& message) { return std::holds_alternative<Progress>(message); }));
}

/// Blocks until the coordinator has heard two more; the first may have been under way.
bool wait_for_two_more(ScriptedCoordinator& coordinator) {
  const std::size_t before = count_progress(coordinator.heard());
  return coordinator.wait_for_all(
      [before](const auto& heard) { return count_progress(heard) >= before + 2; });
}

TEST(Heartbeat, IsSentWithEveryClockInFreeRunning) {
  for (const auto kind :
       {computer::ClockKind::kWall, computer::ClockKind::kCpu, computer::ClockKind::kScripted}) {
    ScriptedCoordinator coordinator(free_running());
    ConnectOptions options;
    options.time = std::make_unique<ManualTimeSource>(kind);
    options.progress_period = Duration::zero();
    options.heartbeat_period = 20us;
    const auto vehicle = connect(coordinator.connect(), std::move(options)).value();
    EXPECT_TRUE(wait_for_two_more(coordinator));
    EXPECT_TRUE(vehicle->command_velocity({}).ok());
    EXPECT_TRUE(wait_for_two_more(coordinator));
    EXPECT_TRUE(vehicle->finish(true, "done", "{}").ok());
  }
}

TEST(Heartbeat, IsNotSentUnderTheBarrierNorWhereItIsOff) {
  struct Case {
    bool free;
    computer::ClockKind clock;
    Duration progress_period, heartbeat_period;
  };
  for (const Case& c : {Case{false, computer::ClockKind::kWall, 0us, 20us},
                        Case{true, computer::ClockKind::kWall, 20us, 0us},
                        Case{false, computer::ClockKind::kScripted, 20us, 20us}}) {
    ManualTimeSource source(c.clock);
    ScriptedCoordinator coordinator(c.free ? free_running() : link::Welcome{});
    ConnectOptions options;
    options.time = std::make_unique<ManualTimeSource>(source);
    options.progress_period = c.progress_period;
    options.heartbeat_period = c.heartbeat_period;
    const auto vehicle = connect(coordinator.connect(), std::move(options)).value();
    for (int i = 0; i < 200; ++i) {
      source.advance(1ms);
      ASSERT_TRUE(vehicle->command_velocity({}).ok());
    }
    EXPECT_EQ(count_progress(coordinator.heard()), 0u);
  }
}

TEST(ProgressReporter, StopsOnDestructionAndAfterAFailedReport) {
  ManualTimeSource source;
  std::atomic<int> calls = 0;
  {
    ProgressReporter never(1h, source, [&] { return ++calls > 0; });
  }
  EXPECT_EQ(calls, 0);

  std::mutex mutex;
  std::condition_variable reported;
  ProgressReporter once(1us, source, [&] {
    const std::lock_guard lock(mutex);
    ++calls;
    reported.notify_one();
    return false;
  });
  std::unique_lock lock(mutex);
  EXPECT_TRUE(reported.wait_for(lock, 20s, [&] { return calls == 1; }));
}

}  // namespace
}  // namespace tether::client
