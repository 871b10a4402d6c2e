#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <tether/base/units.h>
#include <tether/campaign/metrics.h>

namespace tether::campaign {

/// "camera" of "uav1", 0.1 m ahead of its middle, 90 degrees wide: a ray of slope s lies 320·s px
/// beside the middle column, 319.5.
inline record::SensorInfo camera() {
  record::SensorInfo sensor;
  sensor.uav = "uav1";
  sensor.name = "camera";
  sensor.kind = "camera";
  sensor.camera = record::CameraInfo{.p_BS_m = {0.1, 0.0, 0.0},
                                     .width_px = 640,
                                     .height_px = 480,
                                     .fx_px = 320.0,
                                     .fy_px = 320.0,
                                     .cx_px = 319.5,
                                     .cy_px = 239.5};
  return sensor;
}

/// A record made by hand: one UAV "uav1" with `camera()`, and the anchor "box", a cube of 1 m.
class Flight {
 public:
  Flight() {
    record_.header.policy = record::kConservativeBarrier;
    record_.header.ground_truth_period = std::chrono::milliseconds(100);
    record_.header.sensors = {camera()};
    anchor_at(4.6, 2.0);
  }

  Flight& anchor_at(double x_m, double y_m) {
    record_.header.anchors = {{"box", "box", {1, 1, 1}, {x_m, y_m, 0.5}, {1, 0, 0, 0}}};
    return *this;
  }
  Flight& pose(std::int64_t ms, double x_m, double y_m, double yaw_deg) {
    record::GroundTruth truth;
    truth.uav = "uav1";
    truth.at = at(ms);
    truth.p_WB_m[0] = x_m;
    truth.p_WB_m[1] = y_m;
    truth.p_WB_m[2] = 0.5;
    truth.q_WB[0] = std::cos(rad_from_deg(yaw_deg) / 2);
    truth.q_WB[3] = std::sin(rad_from_deg(yaw_deg) / 2);
    record_.ground_truth.push_back({at(ms), order_++, truth});
    return *this;
  }
  /// A read of the camera that was answered `took_ms` later.
  Flight& image(std::int64_t ms, std::uint64_t index, std::int64_t took_ms = 10) {
    record::Interaction read = interaction(record::kSensor, ms);
    read.sensor = "camera";
    read.sample_index = index;
    read.sampled_at = read.sample_state_at = at(ms);
    read.reply_at += std::chrono::milliseconds(took_ms);
    read.st_at_release += std::chrono::milliseconds(took_ms);
    record_.interactions.push_back({read.st_at_release, order_++, read});
    return *this;
  }
  Flight& note(const std::string& topic, const std::string& json) {
    record_.annotations.push_back({{}, order_++, {"uav1", {}, topic, json}});
    return *this;
  }
  Flight& finish(std::int64_t ms) {
    record_.interactions.push_back({at(ms), order_++, interaction(record::kFinish, ms)});
    return *this;
  }

  record::Record& record() { return record_; }
  MetricValue metric(const std::string& kind) const {
    const std::vector<scenario::Metric> metrics = {
        {kind, kind, "Label", "m", "uav1", "box", rad_from_deg(2.0), std::nullopt, "camera"}};
    return compute_metrics(metrics, record_).front();
  }

 private:
  static SimTime at(std::int64_t ms) { return SimTime(std::chrono::milliseconds(ms)); }
  static record::Interaction interaction(std::string_view kind, std::int64_t ms) {
    record::Interaction interaction;
    interaction.uav = "uav1";
    interaction.kind = kind;
    interaction.request_at = interaction.reply_at = same_instant(at(ms));
    interaction.st_at_arrival = interaction.st_at_release = at(ms);
    return interaction;
  }

  record::Record record_;
  std::uint64_t order_ = 0;
};

}  // namespace tether::campaign
