#pragma once

#include <chrono>
#include <cmath>
#include <string>

#include <tether/record/reader.h>

namespace tether::report {

/// A run of "uav1" on "target": `count` reads, 100 ms of ST and ET apart, twice as fast as wall
/// time; a path of 1 m a second to the east, a box to the north of it, and dead reckoning that is
/// 10 % short.
inline record::Record sample_record(std::size_t count) {
  using std::chrono::milliseconds;
  record::Record record;
  record.header.scenario = "turn";
  record.header.condition = "target";
  record.header.policy = record::kConservativeBarrier;
  record.header.seed = 1;
  record::SutInfo sut;
  sut.uav = "uav1";
  sut.sut = "tether-sut 0.1.0";
  sut.clock.kind = computer::ClockKind::kCpu;
  record.header.suts = {sut};
  record.header.anchors = {{"blue_box", "box", {0.4, 0.2, 0.4}, {2.0, 1.0, 1.0}, {1, 0, 0, 0}}};
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = milliseconds(100 * i);
    record::Interaction read;
    read.uav = "uav1";
    read.sequence = i + 1;
    read.kind = record::kSensor;
    read.request_at = ExecTime(at);
    read.reply_at = ExecTime(at + milliseconds(30));
    read.st_at_arrival = SimTime(at - milliseconds(i == 0 ? 0 : 5));
    read.st_at_release = SimTime(at + milliseconds(30));
    read.lag = milliseconds(i == 0 ? 0 : 5);
    read.wall_at_arrival = WallTime(std::chrono::seconds(7) + at / 2);
    read.wall_at_release = WallTime(std::chrono::seconds(7) + at / 2 + milliseconds(15));
    record.interactions.push_back({read.st_at_release, i, read});

    record::GroundTruth truth;
    truth.uav = "uav1";
    truth.at = SimTime(at);
    truth.p_WB_m[0] = 0.1 * static_cast<double>(i);
    record.ground_truth.push_back({truth.at, i, truth});

    const std::string x = std::to_string(0.09 * static_cast<double>(i));
    record.annotations.push_back(
        {truth.at, i, {"uav1", read.reply_at, "odometry", R"({"y_m":0,"x_m":)" + x + "}"}});
  }
  return record;
}

}  // namespace tether::report
