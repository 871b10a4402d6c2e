#include "camera/camera_device.h"

#include "manual_clock.h"

#include <deque>
#include <random>

#include <gmock/gmock.h>

namespace tether::devices {
namespace {

using client::Read;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using testing::HasSubstr;

constexpr Duration kPeriod = milliseconds(40);

/// Image k is taken at k periods after the start, and arrives `latency` later, in one of `buffers`;
/// where all are full it is lost. An image's first byte is its number.
class FakeCamera final : public FrameSource {
 public:
  ManualClock* clock;
  Duration start = clock->now();
  Duration latency = milliseconds(25);
  std::size_t buffers = 2;
  int last_image = 200;
  double rate_hz = 25.0;
  bool is_on_epoch = false;     // timestamps of another clock
  bool is_stuck_clock = false;  // the first timestamp for ever
  bool breaks_images = false;

  explicit FakeCamera(ManualClock& manual) : clock(&manual) {}

  ImageFormat format() const override { return {1, 1, rate_hz}; }
  bool grab() override {
    fill();
    if (queue_.empty()) {
      clock->sleep_until(arrival(next_));
      fill();
    }
    if (queue_.empty() || queue_.front() > last_image) return false;
    grabbed_ = queue_.front();
    queue_.pop_front();
    return true;
  }
  bool retrieve(uav::CameraSample& into) override {
    into.width_px = into.height_px = 1;
    into.rgb.assign(3, static_cast<std::uint8_t>(grabbed_));
    return !breaks_images;
  }
  double position_ms() const override {
    const double ms = to_seconds(taken(is_stuck_clock ? 0 : grabbed_)) * 1e3;
    return is_on_epoch ? ms + 1.7e12 : ms;
  }
  Duration taken(int image) const { return start + image * kPeriod; }

 private:
  Duration arrival(int image) const { return taken(image) + latency; }
  void fill() {
    for (; arrival(next_) <= clock->now(); ++next_) {
      if (queue_.size() < buffers) queue_.push_back(next_);
    }
  }

  std::deque<int> queue_;
  int next_ = 0;
  int grabbed_ = 0;
};

class LiveCameraTest : public testing::Test {
 protected:
  LiveCamera make(bool has_timestamps = true) {
    return {time_, "camera /dev/video3", std::move(source_), has_timestamps,
            [] { return std::string("the device is gone"); }};
  }

  ManualClock clock_;
  Timeline time_{clock_};
  std::unique_ptr<FakeCamera> source_ = std::make_unique<FakeCamera>(clock_);
};

TEST_F(LiveCameraTest, DatesAnImageByTheDevicesTimestampOnTheEtAxis) {
  clock_.advance(nanoseconds(1'234'567));
  source_->start = clock_.now();
  LiveCamera camera = make();
  const auto image = camera.read(Read::kNext);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->sampled_at, SimTime(nanoseconds(1'234'567)));
  EXPECT_EQ(time_.now(), ExecTime(nanoseconds(1'234'567) + milliseconds(25)));
  EXPECT_EQ(image->index, 0u);
}

TEST_F(LiveCameraTest, AFastReaderGetsEveryImage) {
  LiveCamera camera = make();
  for (int i = 0; i < 20; ++i) {
    const auto image = camera.read(Read::kNext);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->rgb[0], i);
    EXPECT_EQ(image->index, static_cast<std::uint64_t>(i));
    clock_.advance(milliseconds(3));
  }
}

TEST_F(LiveCameraTest, DatesImagesByArrivalWithoutPlausibleTimestamps) {
  struct Case {
    bool is_on_epoch;
    bool has_timestamps;
    Duration latency;
  };
  for (const Case& c : {Case{true, true, milliseconds(25)}, Case{false, false, milliseconds(25)},
                        Case{false, true, milliseconds(6000)}}) {
    source_ = std::make_unique<FakeCamera>(clock_);
    time_ = Timeline(clock_);
    source_->is_on_epoch = c.is_on_epoch;
    source_->latency = c.latency;
    LiveCamera camera = make(c.has_timestamps);
    EXPECT_EQ(camera.read(Read::kNext)->sampled_at, SimTime(c.latency));
  }
}

TEST_F(LiveCameraTest, IgnoresTimestampThatDoesNotAdvance) {
  source_->is_stuck_clock = true;
  LiveCamera camera = make();
  EXPECT_EQ(camera.read(Read::kNext)->sampled_at, SimTime{});
  EXPECT_EQ(camera.read(Read::kNext)->sampled_at, SimTime(milliseconds(65)));
}

// Each image is newer than the one before, and no older than two periods and the transfer.
TEST_F(LiveCameraTest, SlowReaderGetsFreshImagesHoweverManyTheDriverBuffers) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> pause_ms(0, 300);
  for (const std::size_t buffers : {2u, 9u}) {
    source_ = std::make_unique<FakeCamera>(clock_);
    time_ = Timeline(clock_);
    source_->buffers = buffers;
    source_->last_image = 400;
    LiveCamera camera = make();
    SimTime last(-std::chrono::hours(1));
    for (int i = 0; i < 40; ++i) {
      const auto image = camera.read(Read::kNext);
      ASSERT_TRUE(image);
      EXPECT_GT(image->sampled_at, last);
      EXPECT_EQ(image->sampled_at, SimTime(image->rgb[0] * kPeriod));
      EXPECT_LT(same_instant(time_.now()) - image->sampled_at, 2 * kPeriod);
      last = image->sampled_at;
      clock_.advance(milliseconds(pause_ms(random)));
    }
  }
}

TEST_F(LiveCameraTest, ASlowReaderGetsFreshImagesWithoutTimestampsToo) {
  source_->is_on_epoch = true;
  source_->buffers = 4;
  LiveCamera camera = make();
  ASSERT_TRUE(camera.read(Read::kNext));
  clock_.advance(milliseconds(1000));
  const auto image = camera.read(Read::kNext);
  ASSERT_TRUE(image);
  // Images 1 to 4 were waiting; the next that came was taken after the read began.
  EXPECT_EQ(image->rgb[0], 26);
  EXPECT_EQ(image->index, 5u);
}

TEST_F(LiveCameraTest, WithoutARateNothingIsSkipped) {
  source_->rate_hz = 0.0;
  LiveCamera camera = make();
  ASSERT_TRUE(camera.read(Read::kNext));
  clock_.advance(milliseconds(1000));
  EXPECT_EQ(camera.read(Read::kNext)->rgb[0], 1);
}

TEST_F(LiveCameraTest, LatestGivesTheSameImageUntilANewerOneIsDue) {
  LiveCamera camera = make();
  const auto first = camera.read(Read::kLatest);
  ASSERT_TRUE(first);
  clock_.advance(milliseconds(10));
  const auto again = camera.read(Read::kLatest);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->sampled_at, first->sampled_at);
  EXPECT_EQ(again->index, first->index);
  EXPECT_EQ(again->rgb, first->rgb);
  clock_.advance(milliseconds(6));  // 41 ms after it was taken
  EXPECT_GT(camera.read(Read::kLatest)->sampled_at, first->sampled_at);
}

TEST_F(LiveCameraTest, FailsForGoodWhenTheSourceEndsOrAnImageIsUnusable) {
  for (const bool breaks_images : {false, true}) {
    source_ = std::make_unique<FakeCamera>(clock_);
    source_->last_image = 1;
    source_->breaks_images = breaks_images;
    LiveCamera camera = make();
    for (int i = 0; i < 2; ++i) EXPECT_NE(camera.read(Read::kNext).ok(), breaks_images);
    for (const Read read : {Read::kNext, Read::kLatest}) {
      const auto none = camera.read(read);
      ASSERT_FALSE(none);
      EXPECT_EQ(none.failure().kind, Failure::Kind::kDisconnected);
      EXPECT_THAT(none.failure().message, HasSubstr("camera /dev/video3"));
    }
  }
}

// ---- played video

/// Images that are all there at once.
class FakeVideo final : public FrameSource {
 public:
  FakeVideo(int images, double rate_hz) : images_(images), rate_hz_(rate_hz) {}
  ImageFormat format() const override { return {1, 1, rate_hz_}; }
  bool grab() override { return ++image_ < images_; }
  bool retrieve(uav::CameraSample& into) override {
    ++decoded;
    into.rgb.assign(3, static_cast<std::uint8_t>(image_));
    return true;
  }
  double position_ms() const override { return 0.0; }
  int decoded = 0;

 private:
  int images_;
  double rate_hz_;
  int image_ = -1;
};

class PlayedVideoTest : public testing::Test {
 protected:
  void open(int images, double rate_hz) {
    auto source = std::make_unique<FakeVideo>(images, rate_hz);
    source_ = source.get();
    auto video = PlayedVideo::create(time_, "camera a.avi", std::move(source), "a.avi");
    ASSERT_TRUE(video);
    video_ = std::move(*video);
    clock_.advance(milliseconds(500));  // between opening and the first read
  }
  void expect_image(Read read, std::uint64_t index, Duration sampled_at, Duration had_at) {
    const auto image = video_->read(read);
    ASSERT_TRUE(image) << image.failure().message;
    EXPECT_EQ(image->index, index);
    EXPECT_EQ(image->rgb[0], index);
    EXPECT_EQ(image->sampled_at, SimTime(sampled_at));
    EXPECT_EQ(time_.now(), ExecTime(had_at));
  }

  ManualClock clock_;
  Timeline time_{clock_};
  FakeVideo* source_ = nullptr;
  std::unique_ptr<PlayedVideo> video_;
};

TEST_F(PlayedVideoTest, PlaysAtItsRateAndSkipsImagesWithoutDecodingThem) {
  open(100, 25.0);
  expect_image(Read::kNext, 0, milliseconds(500), milliseconds(500));
  expect_image(Read::kNext, 1, milliseconds(540), milliseconds(540));
  clock_.advance(milliseconds(15));
  expect_image(Read::kNext, 2, milliseconds(580), milliseconds(580));
  clock_.advance(milliseconds(130));
  expect_image(Read::kNext, 5, milliseconds(700), milliseconds(710));
  EXPECT_EQ(source_->decoded, 4);
  clock_.advance(milliseconds(29));
  expect_image(Read::kLatest, 5, milliseconds(700), milliseconds(739));
  clock_.advance(milliseconds(1));
  expect_image(Read::kLatest, 6, milliseconds(740), milliseconds(740));
}

TEST_F(PlayedVideoTest, ImageIsCurrentFromItsDueTimeToTheNextOnes) {
  constexpr double kRateHz = 30000.0 / 1001.0;
  const auto due = [this](std::uint64_t k) {
    const Duration played = duration_from_seconds(static_cast<double>(k) / kRateHz);
    return time_.monotonic(ExecTime(milliseconds(500) + played));
  };
  open(2000, kRateHz);
  ASSERT_TRUE(video_->read(Read::kNext));
  for (std::uint64_t k = 2; k < 2000; k += 2) {
    clock_.sleep_until(due(k));
    ASSERT_EQ(video_->read(Read::kNext)->index, k);
    clock_.sleep_until(due(k + 1) - nanoseconds(1));
    ASSERT_EQ(video_->read(Read::kLatest)->index, k);
  }
}

TEST_F(PlayedVideoTest, FailsForGoodAtTheEndOfTheFile) {
  open(4, 25.0);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(video_->read(Read::kNext));
  clock_.advance(std::chrono::seconds(1));
  for (int i = 0; i < 2; ++i) {
    const auto none = video_->read(Read::kNext);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.failure().kind, Failure::Kind::kDisconnected);
    EXPECT_THAT(none.failure().message, HasSubstr("camera a.avi"));
  }
}

TEST_F(PlayedVideoTest, RefusesAFileThatSaysNoRate) {
  const auto none =
      PlayedVideo::create(time_, "camera a.avi", std::make_unique<FakeVideo>(3, 0.0), "a.avi");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.failure().kind, Failure::Kind::kInvalid);
}

}  // namespace
}  // namespace tether::devices
