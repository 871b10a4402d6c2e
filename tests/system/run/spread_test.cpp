#include "support/trials.h"

#include <cmath>
#include <future>
#include <numeric>
#include <stdexcept>

#include <gtest/gtest.h>

/// With real CPU times no two trials are alike; a slow simulator must not show in them all the
/// same.
namespace tether::system_test {
namespace {

constexpr int kTrials = 4;
constexpr double kFramePeriod_s = 1.0 / 30.0;

struct Times {
  std::vector<double> values_s;

  double mean() const { return std::accumulate(values_s.begin(), values_s.end(), 0.0) / kTrials; }
  double squared_standard_error() const {
    double sum = 0.0;
    for (const double value : values_s) sum += (value - mean()) * (value - mean());
    return sum / (kTrials - 1) / kTrials;
  }
};

double time_required_s(int seed, const std::vector<std::string>& options) {
  const TempFolder folder;
  const auto scenario = write_face_scenario(folder.path());
  const auto out = folder / "out";
  const Output output = run(with(
      tether({"run", scenario, "--quiet", "--seed", std::to_string(seed), "--out", out}), options));
  EXPECT_EQ(output.code, 0) << output.err;
  const auto result = read_result(out);
  for (const auto& metric : result["metrics"])
    if (metric["name"] == "time_required") return metric["value"];
  throw std::logic_error("time_required is not measured");
}

TEST(Spread, HoldsWhateverASlowSimulatorChanges) {
  Times fast, slow;
  // Both at once, so that other programs on this machine cost both the same.
  for (int seed = 1; seed <= kTrials; ++seed) {
    auto other = std::async(std::launch::async, time_required_s, seed,
                            std::vector<std::string>{"--real-time-factor", "0.5"});
    fast.values_s.push_back(time_required_s(seed, {}));
    slow.values_s.push_back(other.get());
  }
  const double pooled = std::sqrt(fast.squared_standard_error() + slow.squared_standard_error());
  // One frame: whether an image is caught or just missed.
  EXPECT_NEAR(fast.mean(), slow.mean(), 3.0 * pooled + kFramePeriod_s);
}

}  // namespace
}  // namespace tether::system_test
