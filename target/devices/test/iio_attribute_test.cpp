#include "iio_attribute.h"

#include "fake_system.h"
#include "manual_clock.h"

#include <cerrno>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether::devices {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST(ParseNumber, TakesADecimalNumberThatIsAllOfTheText) {
  EXPECT_EQ(parse_number("1234"), 1234.0);
  EXPECT_EQ(parse_number(" -0.001000\n"), -0.001);
  EXPECT_EQ(parse_number("9.80665e0"), 9.80665);
  for (const char* text : {"", " ", "abc", "1.5 dB", "1 2", "nan", "inf", "0x10", "1,5", "1e999"}) {
    EXPECT_EQ(parse_number(text), std::nullopt) << text;
  }
}

class AttributeTest : public testing::Test {
 protected:
  Channel open(const std::string& axis = "") {
    auto channel = Channel::open(system_, clock_, scratch_.path(), base_, axis);
    EXPECT_TRUE(channel);
    return std::move(*channel);
  }

  ScratchFolder scratch_;
  ManualClock clock_;
  FakeSystem system_;
  std::string base_ = "in_distance";
};

TEST_F(AttributeTest, IsReadAgainFromTheBeginning) {
  const std::string path = scratch_.write("in_x", "17\n");
  const Attribute attribute(system_, path);
  EXPECT_EQ(attribute.read(clock_).value, 17.0);
  scratch_.write("in_x", "18\n");
  EXPECT_EQ(attribute.read(clock_).value, 18.0);
}

TEST_F(AttributeTest, ClosesItsFile) {
  {
    Attribute one(system_, scratch_.write("in_x", "17\n"));
    const Attribute moved = std::move(one);
    EXPECT_EQ(moved.read(clock_).value, 17.0);
    EXPECT_EQ(system_.open_descriptors, 1);
  }
  EXPECT_EQ(system_.open_descriptors, 0);
}

TEST_F(AttributeTest, WhatIsNoNumberIsNamedWithItsFile) {
  const std::string path = scratch_.write("in_x", "a lot\n");
  const Reading reading = Attribute(system_, path).read(clock_);
  EXPECT_EQ(reading.fault, path + ": holds 'a lot', which is no number");
  EXPECT_THAT(Attribute(system_, scratch_.write("in_y", "")).read(clock_).fault,
              HasSubstr("in_y: holds ''"));
}

TEST_F(AttributeTest, EachErrorSaysWhatToDo) {
  const std::string path = scratch_.write("in_x", "17\n");
  const std::vector<std::pair<int, std::string>> kCases = {{EACCES, "udev"},
                                                           {EBUSY, "buffer"},
                                                           {ENODEV, "gone"},
                                                           {EIO, "wiring"},
                                                           {ETIMEDOUT, "wiring"}};
  const Attribute attribute(system_, path);
  for (const auto& [error, advice] : kCases) {
    system_.read_errors[path] = {error};
    const Reading reading = attribute.read(clock_);
    EXPECT_EQ(reading.error, error);
    EXPECT_THAT(reading.fault,
                AllOf(StartsWith(path + ": "), HasSubstr(error_text(error)), HasSubstr(advice)));
  }
}

TEST_F(AttributeTest, AFileThatCannotBeOpenedSaysSo) {
  const std::string path = scratch_.write("in_x", "17\n");
  system_.open_errors[path] = EACCES;
  EXPECT_THAT(Attribute(system_, path).read(clock_).fault, HasSubstr("Permission denied"));
  EXPECT_EQ(Attribute(system_, scratch_.path("no_such")).error(), ENOENT);
}

TEST_F(AttributeTest, TriesAgainWhileTheDriverIsNotReady) {
  const std::string path = scratch_.write("in_x", "17\n");
  system_.read_errors[path] = {EAGAIN, EINTR, EAGAIN, 0};
  EXPECT_EQ(Attribute(system_, path).read(clock_).value, 17.0);
}

TEST_F(AttributeTest, GivesUpAfterASecond) {
  const std::string path = scratch_.write("in_x", "17\n");
  system_.read_errors[path] = {EAGAIN};
  const Duration begin = clock_.now();
  EXPECT_EQ(Attribute(system_, path).read(clock_).error, EAGAIN);
  EXPECT_EQ(clock_.now() - begin, std::chrono::seconds(1));
}

// ---- quantities

TEST_F(AttributeTest, AProcessedQuantityIsTakenAsItIs) {
  scratch_.write("in_distance_input", "0.731\n");
  scratch_.write("in_distance_raw", "5\n");
  scratch_.write("in_distance_scale", "100\n");
  EXPECT_EQ(open().read(clock_).value, 0.731);
}

TEST_F(AttributeTest, TheOffsetComesBeforeTheScale) {
  scratch_.write("in_distance_raw", "500\n");
  scratch_.write("in_distance_scale", "0.001000\n");
  scratch_.write("in_distance_offset", "-20\n");
  EXPECT_DOUBLE_EQ(open().read(clock_).value, 0.48);
}

TEST_F(AttributeTest, WithoutOffsetAndScaleRawIsTheQuantity) {
  scratch_.write("in_distance_raw", "3\n");
  EXPECT_EQ(open().read(clock_).value, 3.0);
}

TEST_F(AttributeTest, AnAxisOwnScaleGoesBeforeThatOfAll) {
  base_ = "in_accel";
  scratch_.write("in_accel_x_raw", "10\n");
  scratch_.write("in_accel_y_raw", "10\n");
  scratch_.write("in_accel_scale", "2\n");
  scratch_.write("in_accel_y_scale", "3\n");
  scratch_.write("in_accel_offset", "1\n");
  EXPECT_EQ(open("_x").read(clock_).value, 22.0);
  EXPECT_EQ(open("_y").read(clock_).value, 33.0);
}

TEST_F(AttributeTest, AMeasurementIsOneSystemCall) {
  scratch_.write("in_distance_raw", "500\n");
  scratch_.write("in_distance_scale", "0.001\n");
  const Channel channel = open();
  system_.reads = 0;
  EXPECT_TRUE(channel.read(clock_).ok());
  EXPECT_EQ(system_.reads, 1);
}

TEST_F(AttributeTest, AScaleThatIsNoNumberIsAFault) {
  scratch_.write("in_distance_raw", "500\n");
  scratch_.write("in_distance_scale", "metres\n");
  EXPECT_THAT(open().fault(), HasSubstr("in_distance_scale: holds 'metres'"));
}

TEST_F(AttributeTest, ARawValueThatMayNotBeReadIsAFault) {
  system_.open_errors[scratch_.write("in_distance_raw", "500\n")] = EACCES;
  EXPECT_THAT(open().fault(), HasSubstr("in_distance_raw: Permission denied"));
}

TEST_F(AttributeTest, ADeviceWithoutTheQuantityHasNoChannel) {
  EXPECT_FALSE(Channel::open(system_, clock_, scratch_.path(), "in_distance", ""));
}

}  // namespace
}  // namespace tether::devices
