#include "fake_vehicle.h"

#include <array>
#include <cmath>

#include <gmock/gmock.h>

namespace tether::c_api {
namespace {

using client::Read;
using testing::AllOf;
using testing::HasSubstr;

TEST(ReadCamera, HandsOverTheImageWithoutACopy) {
  auto flown = std::make_unique<Flown>();
  tether_image* image = nullptr;
  ASSERT_EQ(tether_read_camera(flown->vehicle, "camera", TETHER_READ_NEXT, &image), TETHER_OK);
  flown.reset();  // an image outlives its vehicle
  tether_image_info info;
  ASSERT_EQ(tether_image_get_info(image, &info, sizeof info), TETHER_OK);
  EXPECT_EQ(info.sampled_at_ns, 11);
  EXPECT_EQ(info.index, 3u);
  EXPECT_EQ(info.width_px, 4);
  EXPECT_EQ(info.height_px, 2);
  EXPECT_EQ(info.size_bytes, 24u);
  EXPECT_EQ(tether_image_rgb(image)[23], 9);
  EXPECT_EQ(tether_image_rgb(image), image->own.rgb.data());

  tether_image* copy = nullptr;
  ASSERT_EQ(tether_image_copy(image, &copy), TETHER_OK);
  EXPECT_NE(tether_image_rgb(copy), tether_image_rgb(image));
  tether_image_free(image);
  tether_image_free(nullptr);
  EXPECT_EQ(tether_image_rgb(copy)[23], 9);
  tether_image_free(copy);
  EXPECT_EQ(tether_image_copy(nullptr, &copy), TETHER_INVALID);
  EXPECT_EQ(copy, nullptr);
}

TEST(ReadCamera, FillsTheCallersMemoryIfItIsLargeEnough) {
  const Flown flown;
  std::array<std::uint8_t, 30> rgb{};
  const auto read_into = [&](std::size_t size) {
    return tether_read_camera_into(flown.vehicle, "camera", TETHER_READ_NEXT, rgb.data(), size,
                                   nullptr, 0);
  };
  EXPECT_EQ(read_into(23), TETHER_INVALID);
  EXPECT_THAT(tether_last_error(), AllOf(HasSubstr("24"), HasSubstr("23")));
  EXPECT_TRUE(flown.fake->reads.empty());
  EXPECT_EQ(read_into(24), TETHER_OK);
  EXPECT_EQ(rgb[23], 9);
  EXPECT_EQ(rgb[24], 0);
}

TEST(ReadCamera, WithoutColoursFillsNoBuffer) {
  const Flown flown;
  std::array<std::uint8_t, 24> rgb{};
  EXPECT_EQ(tether_read_camera_into(flown.vehicle, "labels", 0, rgb.data(), 24, nullptr, 0),
            TETHER_INVALID);
  EXPECT_THAT(tether_last_error(), HasSubstr("segmentation camera"));
  EXPECT_TRUE(flown.fake->reads.empty());
  tether_image* image = nullptr;
  ASSERT_EQ(tether_read_camera(flown.vehicle, "camera", TETHER_READ_NEXT, &image), TETHER_OK);
  EXPECT_EQ(tether_image_depth_m(image), nullptr);
  EXPECT_EQ(tether_image_labels(image), nullptr);
  tether_image_free(image);
}

TEST(ReadCamera, NothingYetIsAStatusOfItsOwn) {
  const Flown flown;
  flown.fake->failure = Failure{Failure::Kind::kNothingYet, "no new image"};
  tether_image* image = nullptr;
  EXPECT_EQ(tether_read_camera(flown.vehicle, "camera", TETHER_READ_IF_AVAILABLE, &image),
            TETHER_NOTHING_YET);
  EXPECT_EQ(image, nullptr);
  flown.fake->out_of_memory = true;
  EXPECT_EQ(tether_read_camera(flown.vehicle, "camera", 0, &image), TETHER_NO_MEMORY);
  EXPECT_EQ(flown.fake->reads.at(0).second, Read::kIfAvailable);
}

TEST(ReadImu, GivesEveryField) {
  const Flown flown;
  tether_imu_sample sample;
  ASSERT_EQ(tether_read_imu(flown.vehicle, "imu", TETHER_READ_NEXT, &sample, sizeof sample),
            TETHER_OK);
  EXPECT_EQ(sample.sampled_at_ns, 12);
  EXPECT_EQ(sample.index, 4u);
  EXPECT_EQ(sample.angular_velocity_rad_s.y, 2.0);
  EXPECT_EQ(sample.specific_force_m_s2.z, 6.0);
  EXPECT_EQ(sample.q_WS.w, 0.5);
  EXPECT_EQ(sample.q_WS.z, -0.5);
  EXPECT_EQ(flown.fake->reads.at(0), (std::pair<std::string, Read>("imu", Read::kNext)));
}

TEST(ReadRange, ClearsItsOutputOnFailure) {
  const Flown flown;
  tether_range_sample sample{1, 2, 3.0};
  flown.fake->failure = Failure{Failure::Kind::kRunEnded, "time limit"};
  EXPECT_EQ(tether_read_range(flown.vehicle, "down", TETHER_READ_NEXT, &sample, sizeof sample),
            TETHER_RUN_ENDED);
  EXPECT_STREQ(tether_last_error(), "time limit");
  EXPECT_EQ(sample.range_m, 0.0);
}

TEST(ReadBattery, GivesEveryField) {
  const Flown flown;
  tether_battery_sample sample;
  ASSERT_EQ(tether_read_battery(flown.vehicle, &sample, sizeof sample), TETHER_OK);
  EXPECT_EQ(sample.sampled_at_ns, 14);
  EXPECT_EQ(sample.voltage_v, 12.5);
  EXPECT_EQ(sample.current_a, 6.0);
  EXPECT_EQ(sample.charge, 0.75);
  EXPECT_EQ(sample.capacity_c, 7200.0);
  EXPECT_EQ(tether_read_battery(nullptr, &sample, sizeof sample), TETHER_INVALID);
  EXPECT_EQ(tether_read_battery(flown.vehicle, nullptr, sizeof sample), TETHER_INVALID);
  flown.fake->failure = Failure{Failure::Kind::kInvalid, "no battery"};
  EXPECT_EQ(tether_read_battery(flown.vehicle, &sample, sizeof sample), TETHER_INVALID);
  EXPECT_EQ(sample.charge, 0.0) << "a failed read clears its output";
}

TEST(SetQueue, PassesItsArguments) {
  const Flown flown;
  EXPECT_EQ(tether_set_queue(flown.vehicle, "imu", 20), TETHER_OK);
  EXPECT_EQ(flown.fake->queues.at(0), (std::pair<std::string, std::uint32_t>("imu", 20)));
  EXPECT_EQ(tether_set_queue(flown.vehicle, nullptr, 20), TETHER_INVALID);
}

TEST(ReadTogether, GivesAnImageOfEachOrNone) {
  const Flown flown;
  const char* const cameras[] = {"camera", "rgbd"};
  tether_image* images[2] = {};
  ASSERT_EQ(tether_read_together(flown.vehicle, cameras, 2, images), TETHER_OK);
  for (tether_image* image : images) {
    EXPECT_EQ(tether_image_rgb(image)[23], 9);
    tether_image_free(image);
  }
  EXPECT_EQ(tether_read_together(flown.vehicle, cameras, 0, images), TETHER_INVALID);
  const char* const twice[] = {"camera", "camera"};
  EXPECT_EQ(tether_read_together(flown.vehicle, twice, 2, images), TETHER_INVALID);
  flown.fake->failure = Failure{Failure::Kind::kRunEnded, "time limit"};
  EXPECT_EQ(tether_read_together(flown.vehicle, cameras, 2, images), TETHER_RUN_ENDED);
  EXPECT_EQ(images[1], nullptr);
}

TEST(Reading, WrongArgumentsReachNoVehicle) {
  const Flown flown;
  tether_range_sample sample;
  tether_image* image = nullptr;
  EXPECT_EQ(tether_read_range(flown.vehicle, "down", 3, &sample, sizeof sample), TETHER_INVALID);
  EXPECT_EQ(tether_read_range(flown.vehicle, nullptr, 0, &sample, sizeof sample), TETHER_INVALID);
  EXPECT_EQ(tether_read_range(flown.vehicle, "down", 0, &sample, 8), TETHER_INVALID);
  EXPECT_EQ(tether_read_camera(nullptr, "camera", 0, &image), TETHER_INVALID);
  EXPECT_EQ(tether_read_camera(flown.vehicle, "camera", 0, nullptr), TETHER_INVALID);
  EXPECT_EQ(tether_image_rgb(nullptr), nullptr);
  EXPECT_TRUE(flown.fake->reads.empty());
}

TEST(ReadScan, GivesIntensitiesOrNotANumber) {
  const Flown flown;
  const auto put_in = [&](std::vector<float> intensities) {
    flown.fake->navigation = {
        uav::ScanSample{from_ns<SimTime>(3), 4, {1.5F}, std::move(intensities)}};
  };
  float range_m = 0, intensity = 0;
  tether_scan_info info{};
  const auto read = [&](float* intensities) {
    return tether_read_scan_intensities(flown.vehicle, "lidar", TETHER_READ_NEXT, &range_m,
                                        intensities, 1, &info, sizeof info);
  };
  put_in({0.75F});
  ASSERT_EQ(read(&intensity), TETHER_OK);
  EXPECT_EQ(range_m, 1.5F);
  EXPECT_EQ(intensity, 0.75F);
  EXPECT_EQ(info.index, 4u);
  put_in({});
  ASSERT_EQ(read(&intensity), TETHER_OK);
  EXPECT_TRUE(std::isnan(intensity));
  EXPECT_EQ(read(nullptr), TETHER_INVALID);
}

}  // namespace
}  // namespace tether::c_api
