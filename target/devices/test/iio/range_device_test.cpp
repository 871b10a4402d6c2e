#include "iio/range_device.h"

#include "fake_system.h"
#include "manual_clock.h"
#include "opening.h"

#include <cerrno>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether::devices {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class RangeDeviceTest : public testing::Test {
 protected:
  RangeDeviceTest() {
    measure("731");
    scratch_.write("in_distance_scale", "0.001000\n");
  }
  void measure(const std::string& raw) { scratch_.write("in_distance_raw", raw + "\n"); }
  void fail_with(int error) { system_.read_errors[scratch_.path("in_distance_raw")] = {error}; }
  Result<std::unique_ptr<RangeDevice>> open() {
    return RangeDevice::open(system_, time_, "rangefinder iio:x", scratch_.path(), limits_);
  }
  std::unique_ptr<RangeDevice> opened() { return devices::opened(open()); }
  std::string refusal() { return devices::refusal(open(), "rangefinder iio:x"); }

  ScratchFolder scratch_;
  ManualClock clock_;
  Timeline time_{clock_};
  FakeSystem system_;
  uav::RangeProperties limits_{0.05, 2.0};
};

TEST_F(RangeDeviceTest, MeasuresWheneverItIsRead) {
  const auto device = opened();
  clock_.advance(std::chrono::milliseconds(70));
  const auto first = device->read();
  ASSERT_TRUE(first);
  EXPECT_DOUBLE_EQ(first->range_m, 0.731);
  EXPECT_EQ(first->index, 0u);
  EXPECT_EQ(first->sampled_at, SimTime(std::chrono::milliseconds(70)));
  measure("1200");
  clock_.advance(std::chrono::milliseconds(5));
  const auto second = device->read();
  ASSERT_TRUE(second);
  EXPECT_DOUBLE_EQ(second->range_m, 1.2);
  EXPECT_EQ(second->index, 1u);
  EXPECT_EQ(second->sampled_at, SimTime(std::chrono::milliseconds(75)));
}

TEST_F(RangeDeviceTest, TimestampIsTheReturnOfTheRead) {
  const auto device = opened();
  // The driver is not ready twice, which takes two milliseconds.
  system_.read_errors[scratch_.path("in_distance_raw")] = {EAGAIN, EAGAIN, 0};
  EXPECT_EQ(device->read()->sampled_at, SimTime(std::chrono::milliseconds(2)));
}

TEST_F(RangeDeviceTest, ReadsInfinityOutsideItsLimits) {
  const auto expect_ranges = [this](const std::vector<std::pair<std::string, double>>& cases) {
    const auto device = opened();
    for (const auto& [raw, range_m] : cases) {
      measure(raw);
      EXPECT_DOUBLE_EQ(device->read()->range_m, range_m) << raw;
    }
  };
  expect_ranges({{"2001", kInfinity}, {"2000", 2.0}, {"49", -kInfinity}, {"50", 0.05}});
  limits_ = {};  // a maximum of 0 is none
  expect_ranges({{"9000", 9.0}});
  scratch_.write("name", "vl53l0x\n");  // its value for "no target" is 8190 or 8191
  expect_ranges({{"8190", kInfinity}, {"8191", kInfinity}, {"1999", 1.999}});
}

TEST_F(RangeDeviceTest, SomeDriversFailWithEioWhereNothingIsThere) {
  for (const char* name : {"vl53l1x", "srf04"}) {
    system_.read_errors.clear();
    scratch_.write("name", std::string(name) + "\n");
    const auto device = opened();
    fail_with(EIO);
    EXPECT_EQ(device->read()->range_m, kInfinity);
    system_.read_errors.clear();
    EXPECT_DOUBLE_EQ(device->read()->range_m, 0.731);
    fail_with(ENODEV);
    EXPECT_FALSE(device->read());
  }
}

/// A VL53L1X without its interrupt wired, as its driver reads it: measures each 50 ms, and keeps
/// the first measurement since the last read. The range is that at which it was completed, in ms.
class Vl53l1xTest : public RangeDeviceTest {
 protected:
  Vl53l1xTest() {
    scratch_.write("name", "vl53l1x\n");
    limits_ = {};
    system_.before_read = [this] {
      if (!is_running_) return;
      clock_.sleep_until(time_.monotonic(ExecTime(next_)));
      measure(std::to_string(next_ / kMs));
      const Duration now = time_.now().time_since_epoch();
      next_ = (now / kPeriod + 1) * kPeriod;
    };
    device_ = opened();
    is_running_ = true;
    system_.reads = 0;
  }
  double read_ms() { return std::round(device_->read()->range_m * 1e3); }

  static constexpr Duration kMs = std::chrono::milliseconds(1);
  static constexpr Duration kPeriod = 50 * kMs;
  bool is_running_ = false;
  Duration next_ = kPeriod;
  std::unique_ptr<RangeDevice> device_;
};

TEST_F(Vl53l1xTest, GivesEachMeasurementToAFastReader) {
  for (const int completed_ms : {50, 100, 150, 200}) {
    EXPECT_EQ(read_ms(), completed_ms);
    clock_.advance(48 * kMs);  // so that the next is there almost at once
  }
  EXPECT_EQ(system_.reads, 4);
}

TEST_F(Vl53l1xTest, DropsOldMeasurement) {
  EXPECT_EQ(read_ms(), 50);
  clock_.advance(1020 * kMs);  // the one of 100 ms is waiting all the while
  EXPECT_EQ(read_ms(), 1100);
  EXPECT_EQ(system_.reads, 3);
  clock_.advance(1020 * kMs);
  next_ = 2150 * kMs;  // as with its interrupt wired
  EXPECT_EQ(read_ms(), 2150) << "waited for, so it is new";
  EXPECT_EQ(system_.reads, 4);
}

TEST_F(RangeDeviceTest, FailsForGoodWhenTheDeviceFails) {
  for (const int error : {EIO, ENODEV, 0}) {
    measure("731");
    const auto device = opened();
    ASSERT_TRUE(device->read());
    error != 0 ? fail_with(error) : measure("far");
    const auto none = device->read();
    ASSERT_FALSE(none);
    EXPECT_EQ(none.failure().kind, Failure::Kind::kDisconnected);
    EXPECT_THAT(none.failure().message,
                AllOf(StartsWith("rangefinder iio:x "), HasSubstr(scratch_.path("in_distance_raw")),
                      HasSubstr(error != 0 ? error_text(error) : "far")));
    system_.read_errors.clear();
    EXPECT_EQ(device->read().failure().message, none.failure().message);
  }
}

TEST_F(RangeDeviceTest, RefusesDeviceThatCannotMeasure) {
  const std::string raw = scratch_.path("in_distance_raw");
  fail_with(EBUSY);
  EXPECT_THAT(refusal(), HasSubstr(error_text(EBUSY)));
  system_.open_errors[raw] = EACCES;
  EXPECT_THAT(refusal(), HasSubstr(error_text(EACCES)));
  EXPECT_EQ(system_.open_descriptors, 0);
  system_.open_errors.clear();
  std::filesystem::remove(raw);
  EXPECT_THAT(refusal(), HasSubstr("in_distance_raw"));
}

}  // namespace
}  // namespace tether::devices
