#include "iio/iio_attribute.h"

#include "fake_system.h"
#include "manual_clock.h"

#include <cerrno>

#include <gmock/gmock.h>

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
  ScratchFolder scratch_;
  ManualClock clock_;
  FakeSystem system_;
};

TEST_F(AttributeTest, ClosesItsFile) {
  {
    Attribute one(system_, scratch_.write("in_x", "17\n"));
    const Attribute moved = std::move(one);
    EXPECT_EQ(moved.read(clock_).value, 17.0);
    EXPECT_EQ(system_.open_descriptors, 1);
  }
  EXPECT_EQ(system_.open_descriptors, 0);
}

TEST_F(AttributeTest, FaultNamesFileAndError) {
  const std::string path = scratch_.write("in_x", "17\n");
  const Attribute attribute(system_, path);
  for (const int error : {EACCES, EBUSY, ENODEV, EIO, ENOENT}) {
    system_.read_errors[path] = {error};
    const Reading reading = attribute.read(clock_);
    EXPECT_EQ(reading.error, error);
    EXPECT_THAT(reading.fault, AllOf(StartsWith(path + ": "), HasSubstr(error_text(error))));
  }
  system_.open_errors[path] = EACCES;
  EXPECT_EQ(Attribute(system_, path).read(clock_).error, EACCES);
  const Reading text = Attribute(system_, scratch_.write("in_y", "a lot\n")).read(clock_);
  EXPECT_EQ(text.error, 0);
  EXPECT_THAT(text.fault, AllOf(StartsWith(scratch_.path("in_y").string()), HasSubstr("a lot")));
}

TEST_F(AttributeTest, RetriesForOneSecondWhileTheDriverIsNotReady) {
  const std::string path = scratch_.write("in_x", "17\n");
  system_.read_errors[path] = {EAGAIN, EINTR, EAGAIN, 0};
  const Attribute attribute(system_, path);
  EXPECT_EQ(attribute.read(clock_).value, 17.0);
  scratch_.write("in_x", "18\n");
  EXPECT_EQ(attribute.read(clock_).value, 18.0) << "read again from the beginning";
  system_.read_errors[path] = {EAGAIN};
  const Duration begin = clock_.now();
  EXPECT_EQ(attribute.read(clock_).error, EAGAIN);
  EXPECT_EQ(clock_.now() - begin, std::chrono::seconds(1));
}

// ---- channels

TEST_F(AttributeTest, ChannelComputesQuantityFromItsFiles) {
  struct Case {
    std::vector<std::pair<std::string, std::string>> files;
    double value;
  };
  for (const Case& c :
       std::vector<Case>{{{{"in_accel_x_raw", "3"}}, 3.0},
                         {{{"in_accel_x_scale", "0.001"}, {"in_accel_x_offset", "-2"}}, 0.001},
                         {{{"in_accel_scale", "9"}}, 0.001},  // the axis' own scale counts
                         {{{"in_accel_y_raw", "10"}}, 90.0},
                         {{{"in_accel_x_input", "0.731"}}, 0.731}}) {
    for (const auto& [name, text] : c.files) scratch_.write(name, text + "\n");
    const bool is_y = c.files.front().first == "in_accel_y_raw";
    const auto channel =
        Channel::open(system_, clock_, scratch_.path(), "in_accel", is_y ? "_y" : "_x");
    ASSERT_TRUE(channel);
    system_.reads = 0;
    EXPECT_DOUBLE_EQ(channel->read(clock_).value, c.value) << c.files.front().first;
    EXPECT_EQ(system_.reads, 1) << "a measurement is one system call";
  }
}

TEST_F(AttributeTest, UnreadableChannelHasFault) {
  const auto open = [this] {
    return Channel::open(system_, clock_, scratch_.path(), "in_distance", "");
  };
  EXPECT_FALSE(open()) << "the device has no such channel";
  const std::string raw = scratch_.write("in_distance_raw", "500\n");
  const std::string scale = scratch_.write("in_distance_scale", "metres\n");
  EXPECT_THAT(open()->fault(), AllOf(StartsWith(scale), HasSubstr("metres")));
  system_.open_errors[raw] = EACCES;
  EXPECT_THAT(open()->fault(), StartsWith(raw));
}

}  // namespace
}  // namespace tether::devices
