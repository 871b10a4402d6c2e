#include "camera/camera.h"

#include "camera_fixture.h"
#include "clocks.h"

#include <cerrno>
#include <deque>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <tether/base/random.h>

namespace tether::as_is {
namespace {

using std::chrono::milliseconds;

class AsIsCamera : public testing::Test {
 protected:
  AsIsCamera() { opener_.signal = ::eventfd(0, EFD_SEMAPHORE | EFD_NONBLOCK); }
  ~AsIsCamera() override { ::close(opener_.signal); }

  int ask(unsigned long request, void* argument) {
    return camera_.answer(opener_, request, argument);
  }
  std::uint32_t request(std::uint32_t count) {
    v4l2_requestbuffers buffers = buffers_of(count);
    EXPECT_EQ(ask(VIDIOC_REQBUFS, &buffers), 0);
    return buffers.count;
  }
  int queue(std::uint32_t index) {
    v4l2_buffer buffer = buffer_of(index);
    return ask(VIDIOC_QBUF, &buffer);
  }
  int stream() {
    std::uint32_t type = kType;
    return ask(VIDIOC_STREAMON, &type);
  }
  /// With so many buffers queued, from now on.
  void stream_with(std::uint32_t count) {
    request(count);
    for (std::uint32_t i = 0; i < count; ++i) EXPECT_EQ(queue(i), 0);
    EXPECT_EQ(stream(), 0);
  }
  /// At that time; what is wrong is in `error_`.
  v4l2_buffer dequeue(ExecTime at) {
    arrivals_.now = at;
    camera_.take_arrived();
    v4l2_buffer buffer = buffer_of();
    error_ = ask(VIDIOC_DQBUF, &buffer);
    return buffer;
  }
  bool is_readable() const {
    pollfd fd{opener_.signal, POLLIN, 0};
    return ::poll(&fd, 1, 0) == 1;
  }

  Arrivals arrivals_{milliseconds(25)};
  Camera camera_{camera_of(), 0, arrivals_.images()};
  Camera::Opener opener_;
  int error_ = 0;
};

ExecTime ms(std::int64_t value) {
  return ExecTime(milliseconds(value));
}

TEST_F(AsIsCamera, DescribesItsOnlySizeAndRateInEachFormat) {
  v4l2_capability capability{};
  ASSERT_EQ(ask(VIDIOC_QUERYCAP, &capability), 0);
  EXPECT_STREQ(reinterpret_cast<const char*>(capability.card), "front");
  EXPECT_TRUE(capability.device_caps & V4L2_CAP_STREAMING);
  std::vector<std::uint32_t> codes;
  v4l2_fmtdesc format{};
  for (format.type = kType; ask(VIDIOC_ENUM_FMT, &format) == 0; ++format.index) {
    v4l2_frmsizeenum size{};
    size.pixel_format = format.pixelformat;
    EXPECT_EQ(ask(VIDIOC_ENUM_FRAMESIZES, &size), 0);
    EXPECT_EQ(size.discrete.width, 4U);
    v4l2_frmivalenum interval{};
    interval.pixel_format = format.pixelformat;
    interval.width = 4;
    interval.height = 2;
    EXPECT_EQ(ask(VIDIOC_ENUM_FRAMEINTERVALS, &interval), 0);
    EXPECT_EQ(interval.discrete.numerator, 1U);
    EXPECT_EQ(interval.discrete.denominator, 30U);
    codes.push_back(format.pixelformat);
  }
  EXPECT_EQ(codes.size(), pixel_formats().size());
  v4l2_queryctrl control{};
  EXPECT_EQ(ask(VIDIOC_QUERYCTRL, &control), EINVAL);
  v4l2_exportbuffer other{};
  EXPECT_EQ(ask(VIDIOC_EXPBUF, &other), ENOTTY);
  EXPECT_EQ(ask(VIDIOC_QUERYCAP, nullptr), EFAULT);
}

TEST_F(AsIsCamera, AFormatOfAnotherSizeBecomesItsOwn) {
  v4l2_format format{};
  format.type = kType;
  format.fmt.pix.width = 1920;
  format.fmt.pix.pixelformat = V4L2_PIX_FMT_BGR24;
  ASSERT_EQ(ask(VIDIOC_S_FMT, &format), 0);
  EXPECT_EQ(format.fmt.pix.width, 4U);
  EXPECT_EQ(format.fmt.pix.sizeimage, 24U);
  format.fmt.pix.pixelformat = V4L2_PIX_FMT_H264;
  ASSERT_EQ(ask(VIDIOC_TRY_FMT, &format), 0);
  EXPECT_EQ(format.fmt.pix.pixelformat, V4L2_PIX_FMT_YUYV);
  ASSERT_EQ(ask(VIDIOC_G_FMT, &format), 0);
  EXPECT_EQ(format.fmt.pix.pixelformat, V4L2_PIX_FMT_BGR24) << "only tried";
  request(2);
  EXPECT_EQ(ask(VIDIOC_S_FMT, &format), EBUSY);
}

TEST_F(AsIsCamera, AnImageIsNotThereBeforeItsTime) {
  stream_with(2);
  dequeue(ms(25) - Duration(1));
  EXPECT_EQ(error_, EAGAIN);
  EXPECT_FALSE(is_readable());
  const v4l2_buffer first = dequeue(ms(25));
  EXPECT_EQ(error_, 0);
  EXPECT_EQ(first.sequence, 0U);
  EXPECT_EQ(first.timestamp.tv_sec, kUptime_s);
  EXPECT_TRUE(first.flags & V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC);
}

// The old ones stay, and the numbers show the gap.
TEST_F(AsIsCamera, ImagesThatFindNoBufferAreLost) {
  stream_with(2);
  EXPECT_EQ(dequeue(ms(95)).sequence, 0U);
  EXPECT_TRUE(is_readable());
  EXPECT_EQ(queue(0), 0);
  EXPECT_EQ(dequeue(ms(95)).sequence, 1U);
  EXPECT_FALSE(is_readable());
  dequeue(ms(104));
  EXPECT_EQ(error_, EAGAIN);
  EXPECT_EQ(dequeue(ms(105)).sequence, 8U);
}

TEST_F(AsIsCamera, ABufferThatIsQueuedLateGetsNothingOfBefore) {
  stream_with(1);
  EXPECT_EQ(dequeue(ms(40)).sequence, 0U);
  arrivals_.now = ms(60);
  EXPECT_EQ(queue(0), 0);
  dequeue(ms(60));
  EXPECT_EQ(error_, EAGAIN);
  EXPECT_EQ(dequeue(ms(66)).sequence, 4U);
}

TEST_F(AsIsCamera, WhatWasSampledBeforeTheStreamIsNoneOfIt) {
  arrivals_.now = ms(101);
  stream_with(4);
  dequeue(ms(134));
  EXPECT_EQ(error_, EAGAIN);
  const v4l2_buffer first = dequeue(ms(135));
  EXPECT_EQ(error_, 0);
  EXPECT_EQ(first.timestamp.tv_usec, 110'000);
  EXPECT_EQ(first.sequence, 0U);
}

TEST_F(AsIsCamera, OnlyWhoRequestedBuffersMayUseThem) {
  Camera::Opener other;
  std::uint32_t type = kType;
  v4l2_requestbuffers buffers = buffers_of(2);
  stream_with(2);
  EXPECT_EQ(camera_.answer(other, VIDIOC_REQBUFS, &buffers), EBUSY);
  EXPECT_EQ(camera_.answer(other, VIDIOC_STREAMON, &type), EBUSY);
  camera_.close(other);
  dequeue(ms(50));
  EXPECT_EQ(error_, 0);
  camera_.close(opener_);
  EXPECT_EQ(camera_.answer(other, VIDIOC_REQBUFS, &buffers), 0);
  camera_.close(other);
}

TEST_F(AsIsCamera, RefusesWhatADriverRefuses) {
  EXPECT_EQ(stream(), EINVAL) << "no buffers";
  EXPECT_EQ(request(1000), 32U);
  EXPECT_EQ(queue(32), EINVAL);
  EXPECT_EQ(queue(0), 0);
  EXPECT_EQ(queue(0), EINVAL) << "twice";
  dequeue(ms(50));
  EXPECT_EQ(error_, EINVAL) << "not streaming";
  v4l2_requestbuffers user = buffers_of(2);
  user.memory = V4L2_MEMORY_USERPTR;
  EXPECT_EQ(ask(VIDIOC_REQBUFS, &user), EINVAL);
}

TEST_F(AsIsCamera, TheEndOfAStreamTakesWhatWasFilled) {
  stream_with(2);
  dequeue(ms(60));
  std::uint32_t type = kType;
  EXPECT_EQ(ask(VIDIOC_STREAMOFF, &type), 0);
  EXPECT_FALSE(is_readable());
  EXPECT_EQ(queue(0), 0);
  EXPECT_EQ(request(0), 0U);
  EXPECT_EQ(camera_.memory(), -1);
}

// What a driver does, one arrival after the other.
struct Reference {
  std::uint32_t free = 0;
  std::uint64_t next = 0;
  std::deque<std::uint64_t> filled{};

  void arrive_until(ExecTime now, Duration delay) {
    for (; ExecTime(next * Arrivals::kPeriod + delay) <= now; ++next) {
      if (free == 0) continue;
      --free;
      filled.push_back(next);
    }
  }
};

TEST_F(AsIsCamera, AnyProgramGetsWhatADriverThatIsAlwaysThereGives) {
  const Duration delay = milliseconds(25);
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    Arrivals arrivals(delay);
    Camera camera(camera_of(), 0, arrivals.images());
    const Camera::Opener opener{::eventfd(0, EFD_SEMAPHORE | EFD_NONBLOCK)};
    KeyedRandom random({.seed = seed});
    const std::uint32_t count = 1 + random.bits() % 4;
    v4l2_requestbuffers buffers = buffers_of(count);
    ASSERT_EQ(camera.answer(opener, VIDIOC_REQBUFS, &buffers), 0);
    std::uint32_t type = kType;
    ASSERT_EQ(camera.answer(opener, VIDIOC_STREAMON, &type), 0);
    std::vector<std::uint32_t> own(count);
    for (std::uint32_t i = 0; i < count; ++i) own[i] = i;
    Reference reference;
    for (int step = 0; step < 300; ++step) {
      arrivals.now += Duration(random.bits() % 20'000'000);
      reference.arrive_until(arrivals.now, delay);
      v4l2_buffer buffer = buffer_of();
      if (!own.empty() && random.bits() % 2 == 0) {
        buffer.index = own.back();
        own.pop_back();
        ASSERT_EQ(camera.answer(opener, VIDIOC_QBUF, &buffer), 0);
        ++reference.free;
        continue;
      }
      camera.take_arrived();
      const int error = camera.answer(opener, VIDIOC_DQBUF, &buffer);
      ASSERT_EQ(error, reference.filled.empty() ? EAGAIN : 0) << seed << " " << step;
      if (error != 0) continue;
      own.push_back(buffer.index);
      const auto sampled_at = std::chrono::seconds(buffer.timestamp.tv_sec - kUptime_s) +
                              std::chrono::microseconds(buffer.timestamp.tv_usec);
      ASSERT_EQ(sampled_at, reference.filled.front() * Arrivals::kPeriod);
      reference.filled.pop_front();
    }
    camera.close(opener);
    ::close(opener.signal);
  }
}

}  // namespace
}  // namespace tether::as_is
