#include <atomic>
#include <csignal>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/child_process.h>
#include <tether/os/process_table.h>
#include <tether/os/text_file.h>
#include <tether/runner/trial_server.h>

/// Servers that are copies of the test. Servers that are new processes: tests/system/campaign.
namespace tether::runner {
namespace {

class Servers : public testing::Test {
 protected:
  /// Trials whose result has the seed that is in memory.
  TrialService service() {
    return {.prepare = [](const TrialRequest&) {},
            .run =
                [this](const TrialRequest& request) {
                  scenario::Scenario scenario;
                  auto result = campaign::make_setup_failure(scenario, {}, seed_, "not flown");
                  campaign::write_result(request.folder, result);
                  return 0;
                }};
  }
  std::filesystem::path folder(const std::string& name) {
    std::filesystem::create_directories(scratch_.path(name));
    return scratch_.path(name);
  }

  ScratchFolder scratch_;
  std::uint64_t seed_ = 7;
};

TEST_F(Servers, HaveInMemoryWhatTheirProcessHasRead) {
  TrialServers servers;
  servers.start(2, service());
  seed_ = 8;
  std::vector<std::jthread> at_once;
  std::atomic<int> right = 0;
  for (const std::string name : {"a", "b"})
    at_once.emplace_back([&, name] {
      const auto result = servers.run({.scenario = "s.toml", .folder = folder(name)}, {});
      if (result && result->seed == 7) ++right;
    });
  at_once.clear();
  EXPECT_EQ(right, 2);
}

TEST_F(Servers, SayHowATrialEndedThatLeavesNoResult) {
  TrialServers servers;
  servers.start(1, {.prepare = [](const TrialRequest&) {},
                    .run = [](const TrialRequest&) { return raise(SIGKILL); }});
  const Error error = thrown_error(
      ErrorCode::kSetup, [&] { servers.run({.scenario = "s.toml", .folder = folder("a")}, {}); });
  EXPECT_NE(std::string(error.what()).find("signal 9"), std::string::npos) << error.what();
}

TEST_F(Servers, EndWhenTheirProcessIsKilled) {
  os::adopt_orphans();
  const auto list = scratch_.path("servers");
  os::ChildProcess campaign(
      {.arguments = {"a campaign"}, .environment = {}, .log = {}, .body = [&] {
         TrialServers servers;
         servers.start(3, service());
         std::ostringstream text;
         for (const pid_t server : os::children_of(getpid())) text << server << ' ';
         os::write_file_atomically(list, text.str());
         return raise(SIGKILL);
       }});
  ASSERT_TRUE(campaign.wait(std::chrono::seconds(60)));
  std::istringstream servers(os::read_file(list));
  int count = 0;
  for (pid_t server = 0; servers >> server; ++count) {
    const auto is_running = [&] {
      const auto stat = os::process_stat(server);
      return stat && stat->state != 'Z' && stat->state != 'X';
    };
    while (is_running()) std::this_thread::yield();
  }
  EXPECT_EQ(count, 3);
  os::end_orphans({});
}

}  // namespace
}  // namespace tether::runner
