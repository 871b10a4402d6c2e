#include "fake_vehicle.h"

#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include <tether/client.hpp>

/// The C++17 API over a fake; that it compiles as a user's compiler wants it is header_cpp17.cpp's.
namespace tether::c_api {
namespace {

using namespace std::chrono_literals;

class CppApi : public testing::Test {
 protected:
  CppApi() : vehicle_(make()) {}

  FakeVehicle* fake_ = nullptr;
  api::Vehicle vehicle_;

 private:
  api::Vehicle make() {
    auto fake = std::make_unique<FakeVehicle>();
    fake_ = fake.get();
    return api::Vehicle(new tether_vehicle(std::move(fake)));
  }
};

TEST_F(CppApi, KnowsTheCatalogue) {
  EXPECT_STREQ(vehicle_.uav_name(), "uav1");
  ASSERT_EQ(vehicle_.sensor_count(), 12u);
  const auto camera = vehicle_.find_sensor("camera");
  ASSERT_TRUE(camera.has_value());
  EXPECT_EQ(camera->kind(), api::SensorKind::kCamera);
  EXPECT_STREQ(camera->name(), "camera");
  EXPECT_EQ(camera->rate_hz(), 30.0);
  EXPECT_EQ(camera->mounting().position_m.x, 0.1);
  EXPECT_EQ(camera->camera_model()->width_px, 4);
  const auto limits = camera->range_limits();
  ASSERT_FALSE(limits.ok());
  EXPECT_EQ(limits.failure().code(), api::Code::kInvalid);
  EXPECT_EQ(vehicle_.sensor_at(2)->range_limits()->max_m, 8.0);
  EXPECT_FALSE(vehicle_.find_sensor("nose").has_value());

  ASSERT_EQ(vehicle_.anchor_count(), 2u);
  EXPECT_STREQ(vehicle_.anchor_at(1)->name(), "ball");
  const auto box = vehicle_.find_anchor("blue_box");
  EXPECT_EQ(box->shape(), api::AnchorShape::kBox);
  EXPECT_EQ(box->size_m().x, 0.4);
  EXPECT_EQ(box->color().z, 0.85);
}

TEST_F(CppApi, ReadsTheBattery) {
  const auto battery = vehicle_.read_battery();
  ASSERT_TRUE(battery.ok());
  EXPECT_EQ(battery->charge, 0.75);
  EXPECT_EQ(api::sampled_at(*battery).time_since_epoch().count(), 14);
  fake_->failure = Failure{Failure::Kind::kInvalid, "no battery"};
  EXPECT_EQ(vehicle_.read_battery().failure().code(), api::Code::kInvalid);
}

TEST_F(CppApi, StagesEndWithTheirObjects) {
  {
    const api::Stage outer(vehicle_, "decide");
    const api::Stage inner(vehicle_, "detect");
  }
  EXPECT_EQ(fake_->said, (std::vector<std::string>{"begin decide", "begin detect", "end", "end"}));
  fake_->failure = Failure{Failure::Kind::kInvalid, "bad name"};
  { const api::Stage none(vehicle_, ""); }
  EXPECT_EQ(fake_->said.size(), 5u);
}

TEST_F(CppApi, ReadsDepthsAndLabels) {
  fake_->image.rgb.clear();
  fake_->image.depth_m = {0.5F, 1, 2, 3, 4, 5, 6, 7};
  fake_->image.labels = {0, 1, 2, 0, 0, 0, 0, 2};
  const auto image = vehicle_.read_camera("labels");
  ASSERT_TRUE(image.ok());
  EXPECT_EQ(image->rgb(), nullptr);
  EXPECT_EQ(image->size_bytes(), 0u);
  EXPECT_EQ(image->depth_m()[7], 7.0F);
  const auto labels = vehicle_.find_sensor("labels");
  EXPECT_EQ(labels->kind(), api::SensorKind::kSegmentationCamera);
  EXPECT_STREQ(labels->label_model(image->labels()[7]), "blue_box");
}

TEST_F(CppApi, ReadsSensors) {
  auto image = vehicle_.read_camera("camera");
  ASSERT_TRUE(image.ok());
  const api::Image kept = *std::move(image);
  EXPECT_EQ(kept.width_px(), 4);
  EXPECT_EQ(kept.height_px(), 2);
  EXPECT_EQ(kept.index(), 3u);
  EXPECT_EQ(kept.sampled_at(), api::SimTime(11ns));
  EXPECT_EQ(kept.size_bytes(), 24u);
  EXPECT_EQ(kept.pixel(3, 1)[2], 9);

  std::array<std::uint8_t, 24> rgb{};
  EXPECT_EQ(vehicle_.read_camera_into("camera", rgb.data(), rgb.size(), api::Read::kLatest)->index,
            3u);
  EXPECT_EQ(rgb[23], 9);
  EXPECT_EQ(fake_->reads.back().second, client::Read::kLatest);
  EXPECT_EQ(api::sampled_at(*vehicle_.read_imu("imu")), api::SimTime(12ns));
  const auto range = vehicle_.read_range("down", api::Read::kIfAvailable);
  EXPECT_EQ(range->range_m, 1.5);
  EXPECT_EQ(range->index, 5u);
  EXPECT_EQ(api::sampled_at(*range), api::SimTime(13ns));
  EXPECT_EQ(fake_->reads.back().second, client::Read::kIfAvailable);
}

TEST_F(CppApi, FliesWaitsAndAnnotates) {
  EXPECT_TRUE(vehicle_.command_velocity({1, 2, 3}, 0.5));
  api::Setpoint there{};
  there.mask = TETHER_POSITION | TETHER_YAW;
  there.yaw_rad = 0.25;
  EXPECT_TRUE(vehicle_.command(there));
  EXPECT_EQ(fake_->followed.at(0).setpoint.yaw_rad, 0.25);
  EXPECT_EQ(vehicle_.flight_limits().max_thrust_N, 24.0);
  EXPECT_EQ(fake_->commands.at(0), (uav::VelocityCommand{{1, 2, 3}, 0.5}));
  EXPECT_TRUE(vehicle_.sleep_until(api::ExecTime(2s)));
  EXPECT_TRUE(vehicle_.sleep_for(5ms));
  EXPECT_EQ(vehicle_.now(), api::ExecTime(2005ms));
  EXPECT_TRUE(vehicle_.annotate("a", "{}"));
  EXPECT_TRUE(vehicle_.finish(true, "there"));
  EXPECT_TRUE(vehicle_.finish(false, "lost", "{}"));
  EXPECT_THAT(fake_->said, testing::ElementsAre("a {}", "reached there ", "missed lost {}"));
  EXPECT_FALSE(vehicle_.is_concurrent());
  fake_->concurrent = true;
  EXPECT_TRUE(vehicle_.is_concurrent());
}

TEST_F(CppApi, SubscribesWithAnyCallable) {
  fake_->concurrent = true;
  fake_->reads_left = 3;
  std::vector<std::optional<api::Image>> kept;
  auto subscription = vehicle_.subscribe_camera("camera", [&](api::ImageView image) {
    auto copy = image.copy();
    ASSERT_TRUE(copy.ok());
    kept.emplace_back(*std::move(copy));
  });
  ASSERT_TRUE(subscription.ok());
  while (subscription->status().ok()) std::this_thread::yield();
  EXPECT_EQ(subscription->status().failure().code(), api::Code::kRunEnded);
  ASSERT_EQ(kept.size(), 3u);
  EXPECT_EQ(kept[2]->pixel(3, 1)[2], 9);

  double sum = 0.0;
  fake_->reads_left = 2;
  const auto ranges = vehicle_.subscribe_range(
      "ahead", [&sum](const api::RangeSample& sample) { sum += sample.range_m; });
  ASSERT_TRUE(ranges.ok());
  while (ranges->status().ok()) std::this_thread::yield();
  fake_->reads_left = 1;
  const auto imus = vehicle_.subscribe_imu(
      "imu", [&sum](const api::ImuSample& sample) { sum += sample.specific_force_m_s2.y; });
  ASSERT_TRUE(imus.ok());
  while (imus->status().ok()) std::this_thread::yield();
  EXPECT_EQ(sum, 2 * 1.5 + 5.0);

  fake_->concurrent = false;
  const auto refused = vehicle_.subscribe_imu("imu", [](const api::ImuSample&) {});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.failure().code(), api::Code::kInvalid);
}

TEST_F(CppApi, SubscribesToEveryKindOfNavigation) {
  fake_->concurrent = true;
  uav::NavSatSample position;
  position.latitude_deg = 48.0;
  uav::OdometrySample pose;
  pose.p_WS.z = 3.0;
  fake_->navigation = {position,
                       uav::MagnetometerSample{from_ns<SimTime>(2), 2, {1e-5, 2e-5, 0}},
                       uav::BarometerSample{from_ns<SimTime>(3), 3, 9e4, 900.0},
                       pose,
                       uav::ScanSample{from_ns<SimTime>(5), 5, {1.5F, 2.5F}},
                       uav::JointStateSample{from_ns<SimTime>(6), 6, {0.5, -0.25}}};
  std::vector<double> got;
  const auto deliver_one = [&](auto subscribe) {
    fake_->reads_left = 1;
    const auto subscription = subscribe();
    ASSERT_TRUE(subscription.ok());
    while (subscription->status().ok()) std::this_thread::yield();
  };
  deliver_one([&] {
    return vehicle_.subscribe_navsat(
        "gps", [&](const api::NavSatSample& s) { got.push_back(s.latitude_deg); });
  });
  deliver_one([&] {
    return vehicle_.subscribe_magnetometer(
        "compass", [&](const api::MagnetometerSample& s) { got.push_back(s.field_T.y); });
  });
  deliver_one([&] {
    return vehicle_.subscribe_barometer(
        "air", [&](const api::BarometerSample& s) { got.push_back(s.pressure_Pa); });
  });
  deliver_one([&] {
    return vehicle_.subscribe_odometry(
        "pose", [&](const api::OdometrySample& s) { got.push_back(s.p_WS.z); });
  });
  deliver_one([&] {
    return vehicle_.subscribe_scan("lidar", [&](const api::Scan& s) {
      got.insert(got.end(), {static_cast<double>(s.index), static_cast<double>(s.rays),
                             static_cast<double>(s.ranges_m[1])});
    });
  });
  deliver_one([&] {
    return vehicle_.subscribe_joint_state("joint_state", [&](const api::JointStateSample& s) {
      got.insert(got.end(), s.angles_rad, s.angles_rad + s.joints);
    });
  });
  EXPECT_EQ(got, (std::vector<double>{48.0, 2e-5, 9e4, 3.0, 5.0, 2.0, 2.5, 0.5, -0.25}));
  fake_->reads_left.reset();
  const auto angles = vehicle_.read_joint_state("joint_state");
  ASSERT_TRUE(angles.ok());
  EXPECT_EQ(angles->joints, 2u);
  EXPECT_EQ(angles->angles_rad[1], -0.25);
  EXPECT_EQ(angles->angles_rad[2], 0.0);
}

TEST_F(CppApi, FailuresKeepTheirMessageAfterTheNextCall) {
  fake_->failure = Failure{Failure::Kind::kRunEnded, "time limit"};
  const api::Status ended = vehicle_.sleep_for(1ms);
  const auto image = vehicle_.read_camera("camera");
  fake_->failure = Failure{Failure::Kind::kProtocol, "later"};
  EXPECT_FALSE(vehicle_.finish(true, ""));
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.failure().code(), api::Code::kRunEnded);
  EXPECT_STREQ(ended.failure().message(), "time limit");
  EXPECT_STREQ(image.failure().message(), "time limit");
}

TEST(CppFailure, TruncatesLongMessage) {
  const api::Failure failure(api::Code::kInternal, std::string(600, 'a').c_str());
  EXPECT_EQ(failure.message(), std::string(511, 'a'));
}

TEST(CppOptions, ChecksEachOption) {
  auto options = api::Options::make();
  ASSERT_TRUE(options.ok());
  EXPECT_TRUE(options->set_address("127.0.0.1:1"));
  EXPECT_TRUE(options->set_token("word"));
  EXPECT_TRUE(options->set_uav("uav1"));
  EXPECT_TRUE(options->set_sut_name("pilot"));
  EXPECT_TRUE(options->set_timeouts(1s, 1s));
  const api::Status clock = options->set_clock("sundial");
  ASSERT_FALSE(clock);
  EXPECT_EQ(clock.failure().code(), api::Code::kInvalid);
  // There is no listener on port 1.
  const auto vehicle = api::connect(*options);
  ASSERT_FALSE(vehicle.ok());
  EXPECT_EQ(vehicle.failure().code(), api::Code::kDisconnected) << vehicle.failure().message();
}

}  // namespace
}  // namespace tether::c_api
