#include "support/profile_file.h"
#include "support/trials.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include <gtest/gtest.h>

/// A virtual sensor costs what its profile states, whatever the link or the simulator took
/// (paper, Section IV and Fig. 8).
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

constexpr int kAcquisitions = 150;
constexpr int kSlowAcquisitions = 50;

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

/// The largest distance between the two empirical distribution functions. @pre sorted
double largest_distance(const std::vector<double>& a, const std::vector<double>& b) {
  double distance = 0.0;
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    const double value = std::min(a[i], b[j]);
    while (i < a.size() && a[i] <= value) ++i;
    while (j < b.size() && b[j] <= value) ++j;
    const double share_a = static_cast<double>(i) / static_cast<double>(a.size());
    const double share_b = static_cast<double>(j) / static_cast<double>(b.size());
    distance = std::max(distance, std::abs(share_a - share_b));
  }
  return distance;
}

double kolmogorov_tail(double lambda) {
  double sum = 0.0;
  for (int k = 1; k <= 100; ++k)
    sum += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * lambda * lambda);
  return lambda < 0.2 ? 1.0 : std::clamp(sum, 0.0, 1.0);
}

/// Two-sample Kolmogorov-Smirnov test: how likely two samples of one distribution differ at least
/// as much as these do (asymptotic, with Stephens' correction for small samples; Press et al.,
/// "Numerical Recipes", section 14.3.3). Ties make it larger than it is. @pre neither is empty.
double kolmogorov_smirnov_p(std::vector<double> a, std::vector<double> b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  const auto n = static_cast<double>(a.size());
  const auto m = static_cast<double>(b.size());
  const double effective = std::sqrt(n * m / (n + m));
  return kolmogorov_tail((effective + 0.12 + 0.11 / effective) * largest_distance(a, b));
}

/// What acquiring an image took, each [ms].
struct Acquisitions {
  std::vector<double> stamped_ms;   ///< by the stamps of request and reply
  std::vector<double> measured_ms;  ///< as the software itself timed it
};

/// So many images in a row on a virtual target.
Acquisitions acquire(const TempFolder& folder, const std::string& name, int images,
                     bool has_slow_wire, const std::vector<std::string>& options = {}) {
  const auto out = folder / name;
  const auto scenario = write_hover_scenario(
      folder.path(), "unused",
      {{"time_limit_s = 5", "time_limit_s = 60"}, {"hang_limit_s = 2", "hang_limit_s = 20"}});
  std::vector<std::string> all{"--profile", write_profile(folder), "--condition", "slow"};
  all.insert(all.end(), options.begin(), options.end());
  ExternalRun run(scenario, out, all);

  Variables environment;
  std::optional<SlowWire> wire;
  if (has_slow_wire) {
    wire.emplace(run.address(), 20, 100);
    environment.emplace_back("TETHER_ADDRESS", wire->address());
  }
  const auto profile = folder / (name + ".toml");
  const auto sut = run.start_sut({sut_program(), "characterize", "--sensors", "camera",
                                  "--acquisitions", std::to_string(images), "--out", profile},
                                 environment);
  const Output output = run.wait();
  EXPECT_EQ(output.code, 0) << output.err << sut->err();

  Acquisitions taken{{}, samples_ms(profile, "camera")};
  for (const auto& logged : read_record(out).interactions)
    if (logged.message.sensor == "camera")
      taken.stamped_ms.push_back(1e3 *
                                 to_seconds(logged.message.reply_at - logged.message.request_at));
  return taken;
}

TEST(Acquisition, TakesWhatItsProfileSaysWhateverTheLinkAndTheSimulator) {
  const TempFolder folder;
  const auto at_once = acquire(folder, "at_once", kAcquisitions, false);
  ASSERT_EQ(at_once.measured_ms.size(), kAcquisitions);
  EXPECT_GT(kolmogorov_smirnov_p(at_once.measured_ms, measured_ms()), 0.01);

  const auto slow_wire = acquire(folder, "slow_wire", kSlowAcquisitions, true);
  const auto slow_simulator =
      acquire(folder, "slow_simulator", kSlowAcquisitions, false, {"--real-time-factor", "0.8"});
  for (const Acquisitions& slow : {slow_wire, slow_simulator}) {
    ASSERT_EQ(slow.measured_ms.size(), kSlowAcquisitions);
    EXPECT_GT(kolmogorov_smirnov_p(slow.measured_ms, measured_ms()), 0.01);
    // A delay is drawn for each measurement by its number: the same ones.
    ASSERT_LE(slow.stamped_ms.size(), at_once.stamped_ms.size());
    EXPECT_TRUE(std::ranges::equal(slow.stamped_ms,
                                   std::span(at_once.stamped_ms).first(slow.stamped_ms.size())));
  }

  const double wire_s = read_result(folder / "slow_wire")["this_run"]["wall_s"];
  EXPECT_GT(wire_s, kSlowAcquisitions * 0.04) << "the wire was not slow";
}

// What a sensor with a profile measures is written as an equal profile. Which can be plugged in:
// real_sensors_test.cpp.
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
}

// What the tests above would have refused, with their sizes and their limit: a constant delay of
// the same mean, and one that is a step of the simulator longer.
TEST(Acquisition, TheTestTellsDistributionsApart) {
  const auto right_ms = measured_ms();
  const auto size = static_cast<double>(right_ms.size());
  const double mean_ms = std::accumulate(right_ms.begin(), right_ms.end(), 0.0) / size;
  const std::vector<double> constant_ms(kAcquisitions, mean_ms);
  EXPECT_LT(kolmogorov_smirnov_p(constant_ms, right_ms), 0.01);

  std::vector<double> longer_ms;
  for (int i = 0; i < kAcquisitions; ++i)
    longer_ms.push_back(1.0 +
                        right_ms[static_cast<std::size_t>(i) * right_ms.size() / kAcquisitions]);
  EXPECT_LT(kolmogorov_smirnov_p(longer_ms, right_ms), 0.01);
  for (double& value_ms : longer_ms) value_ms -= 1.0;
  EXPECT_GT(kolmogorov_smirnov_p(longer_ms, right_ms), 0.99);
}

}  // namespace
}  // namespace tether::system_test
