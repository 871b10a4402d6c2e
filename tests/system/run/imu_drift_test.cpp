#include "support/trials.h"

#include <cmath>
#include <future>
#include <iterator>
#include <map>

#include <gtest/gtest.h>

#include <tether/base/units.h>

/// The drift of dead reckoning is what the noise of the shipped IMU and the calibration at rest
/// predict. A noiseless IMU: target/tasks/test/dead_reckoning_test.cpp.
namespace tether::system_test {
namespace {

struct Planar {
  double x_m = 0.0;
  double y_m = 0.0;
};
Planar operator-(const Planar& a, const Planar& b) {
  return {a.x_m - b.x_m, a.y_m - b.y_m};
}

/// The closed path on a scripted clock. Ground truth comes every 10 ms.
record::Record fly(int seed) {
  const TempFolder folder;
  const auto file = write_shipped_scenario(folder.path(), "closed_path", {scripted_host(2)});
  const auto out = folder / "out";
  const Output output =
      run(tether({"run", file, "--quiet", "--seed", std::to_string(seed), "--out", out}),
          std::chrono::seconds(60));
  EXPECT_EQ(output.code, 0) << output.err;
  const auto result = read_result(out);
  EXPECT_EQ(result["outcome"], "goal_reached") << result["reason"];
  EXPECT_TRUE(result["audit"]["passed"]) << result["audit"]["summary"];
  for (const auto& metric : result["metrics"]) EXPECT_TRUE(metric["value"].is_number()) << metric;
  EXPECT_EQ(result["suts"][0]["details"]["status"], "reached");
  return read_record(out);
}

/// What the SUT reckoned after its last reading, the instant of that reading, and that of its
/// first.
struct Reckoning {
  Planar p_H0B;
  SimTime first;
  SimTime last;
};

std::vector<const record::Interaction*> imu_reads(const record::Record& record) {
  std::vector<const record::Interaction*> reads;
  for (const auto& logged : record.interactions)
    if (logged.message.sensor == "imu") reads.push_back(&logged.message);
  return reads;
}

Reckoning reckoning(const record::Record& record) {
  const auto reads = imu_reads(record);
  const auto read_before = [&](ExecTime at) {
    SimTime sampled;
    for (const auto* read : reads)
      if (read->reply_at <= at) sampled = *read->sample_state_at;
    return sampled;
  };
  Reckoning result;
  bool is_first = true;
  for (const auto& logged : record.annotations) {
    if (logged.message.topic != "odometry") continue;
    const auto note = nlohmann::json::parse(logged.message.json);
    result.p_H0B = {note["x_m"], note["y_m"]};
    result.last = read_before(logged.message.at);
    if (is_first) result.first = result.last;
    is_first = false;
  }
  return result;
}

double yaw_rad(const record::GroundTruth& truth) {
  const auto& q = truth.q_WB;
  return std::atan2(2.0 * (q[0] * q[3] + q[1] * q[2]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]));
}

/// Ground truth by instant, up to 10 ms old, in the start-heading frame of a reckoning.
class Truth {
 public:
  Truth(const record::Record& record, SimTime start) {
    for (const auto& logged : record.ground_truth) at_[logged.message.at] = &logged.message;
    start_ = newest(start);
  }

  Planar position(SimTime at) const {
    const auto& p = newest(at)->p_WB_m;
    return turned({p[0] - start_->p_WB_m[0], p[1] - start_->p_WB_m[1]});
  }

 private:
  const record::GroundTruth* newest(SimTime at) const {
    return std::prev(at_.upper_bound(at))->second;
  }
  Planar turned(const Planar& p_W) const {
    const double c = std::cos(yaw_rad(*start_));
    const double s = std::sin(yaw_rad(*start_));
    return {c * p_W.x_m + s * p_W.y_m, -s * p_W.x_m + c * p_W.y_m};
  }

  std::map<SimTime, const record::GroundTruth*> at_;
  const record::GroundTruth* start_ = nullptr;
};

// The standard deviation of one axis after T: what is left of the bias when it was taken from N
// readings of white noise, sigma/sqrt(N), integrated twice; and the white noise itself, a random
// walk of velocity, integrated once more.
double predicted_drift_m(double sigma_m_s2, int rest_readings, double period_s, double t_s) {
  const double bias_m_s2 = sigma_m_s2 / std::sqrt(rest_readings);
  const double of_bias_m = 0.5 * bias_m_s2 * t_s * t_s;
  const double of_noise_m = sigma_m_s2 * std::sqrt(period_s * t_s * t_s * t_s / 3.0);
  return std::hypot(of_bias_m, of_noise_m);
}

TEST(ImuDrift, TheShippedImuDriftsAsItsNoisePredicts) {
  constexpr int kFlights = 6;
  double squares_m2 = 0.0;
  double t_s = 0.0;
  const auto add = [&](const record::Record& record) {
    const Reckoning reckoned = reckoning(record);
    const Planar error = reckoned.p_H0B - Truth(record, reckoned.first).position(reckoned.last);
    squares_m2 += error.x_m * error.x_m + error.y_m * error.y_m;
    t_s = to_seconds(reckoned.last - reckoned.first);
  };
  for (int seed = 1; seed <= kFlights; seed += 2) {
    auto other = std::async(std::launch::async, fly, seed + 1);
    add(fly(seed));
    add(other.get());
  }
  const double drift_m = std::sqrt(squares_m2 / (2 * kFlights));
  const double predicted_m = predicted_drift_m(0.0124, 20, 0.05, t_s);
  // Twelve values: within 45 % but for one case in thirty.
  EXPECT_NEAR(drift_m, predicted_m, 0.45 * predicted_m) << "over " << t_s << " s";
}

}  // namespace
}  // namespace tether::system_test
