#include "support/profile_file.h"
#include "support/trials.h"
#include "support/two_sample.h"

#include <numeric>

#include <gtest/gtest.h>

/// What a virtual sensor costs is what its profile says, whatever the wire or the simulator took
/// (paper, Section IV and Fig. 8).
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

constexpr int kAcquisitions = 150;

/// Two humps, as a sensor that now and then misses its turn has: no mean and no normal distribution
/// would do for it.
std::vector<double> measured_ms() {
  std::vector<double> samples_ms;
  for (int i = 0; i < 60; ++i) samples_ms.push_back(30.0 + 0.05 * i);
  for (int i = 0; i < 20; ++i) samples_ms.push_back(62.0 + 0.2 * i);
  return samples_ms;
}

std::filesystem::path write_profile(const TempFolder& folder) {
  std::string file = "# camera, ms\n";
  for (const double sample_ms : measured_ms()) file += std::to_string(sample_ms) + "\n";
  write_text(folder / "camera_delays.txt", file);
  write_text(folder / "two_humps.toml", R"(name = "two_humps"
[sensors.camera]
kind = "camera"
timing = "on_demand"
delay = { kind = "empirical", file_ms = "camera_delays.txt" }
)");
  return folder / "two_humps.toml";
}

/// A hundred and fifty images in a row on a virtual target; `wire`: the proxy's options, none for
/// no proxy. Returns what each took in ET [ms].
std::vector<double> acquire(const TempFolder& folder, const std::string& name,
                            const std::vector<std::string>& wire,
                            const std::vector<std::string>& options = {}) {
  const auto out = folder / name;
  std::vector<std::string> all{"--profile", write_profile(folder), "--condition", "slow"};
  all.insert(all.end(), options.begin(), options.end());
  const auto scenario = write_hover_scenario(
      folder.path(), "unused",
      {{"time_limit_s = 5", "time_limit_s = 60"}, {"hang_limit_s = 2", "hang_limit_s = 20"}});
  ExternalRun run(scenario, out, all);

  std::vector<std::pair<std::string, std::string>> environment;
  std::unique_ptr<Process> proxy;
  if (!wire.empty()) {
    Command command{{proxy_program(), "0", run.address()}, {}, {}};
    command.arguments.insert(command.arguments.end(), wire.begin(), wire.end());
    proxy = std::make_unique<Process>(command);
    EXPECT_TRUE(proxy->wait_for_out("\n", 10s)) << proxy->err();
    const std::string said = proxy->out();
    environment.emplace_back("TETHER_ADDRESS", said.substr(0, said.find('\n')));
  }
  const auto sut = run.start_sut({sut_program(), "sensor_characterization", "--sensor", "camera",
                                  "--acquisitions", std::to_string(kAcquisitions)},
                                 environment);
  const Output output = run.wait();
  EXPECT_EQ(output.code, 0) << output.err << sut->err();

  std::vector<double> taken_ms;
  for (const auto& logged : read_record(out).interactions)
    if (logged.message.sensor == "camera")
      taken_ms.push_back(1e3 * to_seconds(logged.message.reply_at - logged.message.request_at));
  return taken_ms;
}

TEST(Acquisition, TakesWhatItsProfileSaysWhateverTheLinkAndTheSimulator) {
  const TempFolder folder;
  const auto at_once = acquire(folder, "at_once", {});
  const auto slow_wire = acquire(folder, "slow_wire", {"--delay-ms", "20", "--mbit-s", "100"});
  const auto slow_simulator = acquire(folder, "slow_simulator", {}, {"--real-time-factor", "0.8"});
  ASSERT_EQ(at_once.size(), kAcquisitions);
  EXPECT_GT(kolmogorov_smirnov_p(at_once, measured_ms()), 0.01);

  // A delay is drawn for each measurement by its number: the same ones.
  EXPECT_EQ(slow_wire, at_once);
  EXPECT_EQ(slow_simulator, at_once);

  const double wire_s = read_result(folder / "slow_wire")["this_run"]["wall_s"];
  EXPECT_GT(wire_s, kAcquisitions * 0.04) << "the wire was not slow";
}

// The round trip of a profile: what a sensor with it measures is written as a profile that says the
// same.
TEST(Acquisition, IsCharacterizedIntoAProfileThatSaysTheSame) {
  const TempFolder folder;
  const auto scenario = write_shipped_scenario(folder.path(), "sensor_characterization",
                                               {{"acquisitions = 100", "acquisitions = 150"}});
  const auto out = folder / "out";
  const Output output = run(tether({"run", scenario, "--quiet", "--condition", "host", "--profile",
                                    write_profile(folder), "--out", out}));
  ASSERT_EQ(output.code, 0) << output.err;
  const auto camera_ms = samples_ms(out / "profile.toml", "camera");
  ASSERT_EQ(camera_ms.size(), kAcquisitions);
  EXPECT_GT(kolmogorov_smirnov_p(camera_ms, measured_ms()), 0.01);

  const auto again = folder / "again";
  const Output flown = run(tether({"run", scenario, "--quiet", "--condition", "host", "--profile",
                                   out / "profile.toml", "--out", again, "--seed", "2"}));
  ASSERT_EQ(flown.code, 0) << flown.err;
  EXPECT_GT(kolmogorov_smirnov_p(samples_ms(again / "profile.toml", "camera"), measured_ms()),
            0.01);
}

// The tests above would have seen a delay of the same mean and another shape, or one shifted by a
// step of the simulator.
TEST(Acquisition, TheTestTellsDistributionsApart) {
  const auto samples_ms = measured_ms();
  const auto size = static_cast<double>(samples_ms.size());
  const double mean_ms = std::accumulate(samples_ms.begin(), samples_ms.end(), 0.0) / size;
  EXPECT_LT(kolmogorov_smirnov_p(samples_ms, std::vector<double>(kAcquisitions, mean_ms)), 1e-9);
  auto shifted_ms = samples_ms;
  for (double& value_ms : shifted_ms) value_ms += 1.0;
  EXPECT_LT(kolmogorov_smirnov_p(samples_ms, shifted_ms), 0.05);
  EXPECT_GT(kolmogorov_smirnov_p(samples_ms, samples_ms), 0.99);
}

}  // namespace
}  // namespace tether::system_test
