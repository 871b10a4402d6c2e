#include "fake_wall_timer.h"
#include "progress_reporter.h"
#include "scripted_coordinator.h"
#include "simulated_vehicle_impl.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include <gtest/gtest.h>

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

TEST(Progress, TellsHowFarComputingHasCome) {
  ManualTimeSource source(link::ClockKind::kWall);
  ScriptedCoordinator coordinator(link::Welcome{});
  const auto vehicle = connect_with(coordinator, source);
  for (int i = 1; i <= 50; ++i) {
    source.advance(5ms);
    ASSERT_TRUE(wait_for_progress(coordinator, ExecTime(i * 5ms)));
    ASSERT_TRUE(vehicle->command_velocity({}).ok());
  }
  expect_monotone(coordinator.heard());
}

TEST(Progress, KeepsItsPlaceBetweenRequests) {
  ManualTimeSource source(link::ClockKind::kWall);
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

/// The coordinator holds a reply back while time passes at the SUT's source: not a word comes from
/// the client.
TEST(Progress, IsSilentWhileTheSutIsHeld) {
  ManualTimeSource source(link::ClockKind::kWall);
  struct Held {
    void poll(link::Server& server, Duration max_wait) {
      for (const link::Event& event : server.poll(max_wait)) {
        closed = closed || std::holds_alternative<link::Closed>(event.what);
        if (const auto* said = std::get_if<link::Message>(&event.what)) take(event.peer, *said);
      }
    }
    void take(link::PeerId peer_id, const link::Message& message) {
      peer = peer_id;
      if (const auto* request = std::get_if<Request>(&message)) held = *request;
      if (held && std::holds_alternative<Progress>(message)) ++words_while_held;
      said_hello = said_hello || std::holds_alternative<link::Hello>(message);
    }
    link::PeerId peer = 0;
    bool said_hello = false;
    bool closed = false;
    std::optional<Request> held;
    int words_while_held = 0;
  } held;
  const auto server = link::listen_tcp({"127.0.0.1", 0}, 20s);
  std::thread sut([&source, channel = link::connect_tcp(server->address(), 20s).value()]() mutable {
    ConnectOptions options;
    options.time = std::make_unique<ManualTimeSource>(source);
    options.progress_period = 20us;
    const auto vehicle = connect(std::move(channel), std::move(options)).value();
    ASSERT_TRUE(vehicle->command_velocity({}).ok());
  });
  while (!held.said_hello) held.poll(*server, 100ms);
  server->send(held.peer, link::Welcome{});
  while (!held.held) held.poll(*server, 100ms);
  for (int i = 0; i < 50; ++i) {
    source.advance(1ms);
    held.poll(*server, 200us);  // many periods
  }
  EXPECT_EQ(held.words_while_held, 0);
  const Request request = *std::exchange(held.held, std::nullopt);
  server->send(held.peer, link::Reply{request.sequence, request.issued_at, {}});
  while (!held.closed) held.poll(*server, 100ms);
  sut.join();
}

TEST(Progress, ScriptedClocksReportNone) {
  ManualTimeSource source(link::ClockKind::kScripted);
  ScriptedCoordinator coordinator(link::Welcome{});
  const auto vehicle = connect_with(coordinator, source);
  for (int i = 0; i < 200; ++i) {
    source.advance(1ms);
    ASSERT_TRUE(vehicle->command_velocity({}).ok());
  }
  for (const auto& message : coordinator.heard()) {
    EXPECT_FALSE(std::holds_alternative<Progress>(message));
  }
}

// --- signs of life in free running
// ---------------------------------------------------------------

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

TEST(Heartbeat, OfEveryClockInFreeRunning) {
  for (const auto kind :
       {link::ClockKind::kWall, link::ClockKind::kCpu, link::ClockKind::kScripted}) {
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

TEST(Heartbeat, IsNoneUnderTheBarrierAndNoneWhenNotWanted) {
  for (const bool free : {false, true}) {
    ManualTimeSource source(link::ClockKind::kWall);
    ScriptedCoordinator coordinator(free ? free_running() : link::Welcome{});
    ConnectOptions options;
    options.time = std::make_unique<ManualTimeSource>(source);
    options.progress_period = free ? 20us : 0us;
    options.heartbeat_period = free ? 0us : 20us;
    const auto vehicle = connect(coordinator.connect(), std::move(options)).value();
    for (int i = 0; i < 200; ++i) {
      source.advance(1ms);
      ASSERT_TRUE(vehicle->command_velocity({}).ok());
    }
    EXPECT_EQ(count_progress(coordinator.heard()), 0u);
  }
}

/// The stall before a call and a sleep each last until the coordinator has heard from the SUT.
TEST(Heartbeat, GoesOnDuringStallsAndSleeps) {
  ManualTimeSource source(link::ClockKind::kCpu, 4.0);
  ScriptedCoordinator coordinator(free_running());
  auto wall = std::make_unique<FakeWallTimer>();
  int sleeps = 0;
  wall->during_sleep([&] {
    EXPECT_TRUE(wait_for_two_more(coordinator));
    ++sleeps;
  });
  SimulatedVehicle vehicle(coordinator.connect(), free_running(),
                           std::make_unique<ManualTimeSource>(source), std::move(wall), 20us);
  source.advance(40ms);
  ASSERT_TRUE(vehicle.command_velocity({}).ok());
  EXPECT_EQ(sleeps, 1);
  ASSERT_TRUE(vehicle.sleep_for(20ms).ok());
  EXPECT_EQ(sleeps, 2);
  expect_monotone(coordinator.heard());
}

TEST(ProgressReporter, StopsWhenToldAndWhenTheReportFails) {
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
