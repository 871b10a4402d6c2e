#include "ahead_drawer.h"

#include <array>
#include <atomic>
#include <semaphore>

#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/base_testing/thrown_error.h>

namespace tether::sim {
namespace {

constexpr std::uint64_t kFails = 7;
// Drawers: thread 0, and the one that takes pictures.
constexpr std::size_t kCaller = 1, kNobody = 9;

PictureKey key(std::uint64_t index, std::size_t sensor = 0) {
  return {0, sensor, index, SimTime(std::chrono::milliseconds(index))};
}

/// One thread draws pictures; each waits until the test opens its gate.
class AheadDrawerTest : public ::testing::Test {
 protected:
  ~AheadDrawerTest() override {
    for (Gate& gate : gates_) gate.open.release();
  }
  void expect(std::uint64_t index, std::size_t sensor = 0) {
    drawer_.expect(key(index, sensor), {.at = {}, .state = {static_cast<double>(index)}});
  }
  /// Expects a picture, which a thread begins to draw.
  void begin(std::uint64_t index) {
    expect(index);
    gates_[index].has_begun.acquire();
  }
  void open(std::uint64_t index) { gates_[index].open.release(); }
  /// What is taken; 0: nothing.
  double take(std::uint64_t index, std::size_t sensor = 0) {
    const auto sample = drawer_.take(key(index, sensor));
    return sample ? std::get<uav::RangeSample>(*sample).range_m : 0.0;
  }
  std::uint64_t drawn() const { return drawer_.work().drawn_ahead; }
  std::uint64_t in_vain() const { return drawer_.work().drawn_in_vain; }

  struct Gate {
    std::counting_semaphore<2> has_begun{0};
    std::counting_semaphore<2> open{0};
    Gate* opens = nullptr;  // when it is drawn
    std::atomic<std::size_t> worker{kNobody};
  };
  std::array<Gate, 10> gates_;
  AheadDrawer drawer_{kCaller,
                      [this](std::size_t worker, const PictureKey& picture,
                             const Snapshot& snapshot) -> uav::Sample {
                        Gate& gate = gates_[picture.index];
                        gate.worker = worker;
                        gate.has_begun.release();
                        if (gate.opens != nullptr) gate.opens->open.release();
                        gate.open.acquire();
                        if (picture.index == kFails) throw Error(ErrorCode::kSetup, "lost");
                        return uav::RangeSample{picture.at, picture.index, snapshot.state.at(0)};
                      }};
};

TEST_F(AheadDrawerTest, ReturnsAPictureOnceThatWasBegun) {
  begin(3);
  expect(3);
  EXPECT_EQ(in_vain(), 1u);
  open(3);
  EXPECT_EQ(take(3), 3.0);
  EXPECT_EQ(in_vain(), 0u);
  EXPECT_EQ(drawer_.work().pictures, 1u);
  EXPECT_EQ(take(3), 0.0);
  EXPECT_EQ(drawn(), 1u);
}

TEST_F(AheadDrawerTest, LeavesToTheCallerWhatNoThreadHasBegun) {
  begin(3);
  expect(4);
  EXPECT_EQ(take(4), 0.0);
  open(3);
  EXPECT_EQ(take(3), 0.0);  // earlier than what was taken
  expect(5);
  open(5);
  gates_[5].has_begun.acquire();
  EXPECT_EQ(take(5), 5.0);
  EXPECT_EQ(drawn(), 2u);
  EXPECT_EQ(in_vain(), 1u);
}

// Picture 2 is drawn while the thread draws picture 3, which waits for it here; picture 4 is later.
TEST_F(AheadDrawerTest, TheCallerDrawsAnotherPictureWhileItWaits) {
  gates_[2].opens = &gates_[3];
  begin(3);
  expect(2, 1);
  expect(4, 1);
  open(2);
  EXPECT_EQ(take(3), 3.0);
  EXPECT_EQ(gates_[2].worker, kCaller);
  EXPECT_NE(gates_[4].worker, kCaller);
  EXPECT_EQ(take(2, 1), 2.0);
}

// Part 0 waits for part 1, which the other thread therefore has to draw.
class SharedPicture {
 public:
  explicit SharedPicture(raster::Helpers& helpers) : helpers_(helpers) {}

  void draw() {
    helpers_.share(2, [this](int part) {
      ++times_.at(static_cast<std::size_t>(part));
      if (part == 1) return second_.release();
      first_.release();
      second_.acquire();
    });
  }
  void await_first_part() { first_.acquire(); }
  std::array<int, 2> times() const { return {times_[0], times_[1]}; }

 private:
  raster::Helpers& helpers_;
  std::array<std::atomic<int>, 2> times_{};
  std::binary_semaphore first_{0};
  std::binary_semaphore second_{0};
};

TEST(AheadDrawer, AnIdleThreadHelpsTheCaller) {
  AheadDrawer drawer(1, [](std::size_t, const PictureKey&, const Snapshot&) -> uav::Sample {
    return uav::RangeSample{};
  });
  SharedPicture picture(drawer);
  picture.draw();
  EXPECT_EQ(picture.times(), (std::array{1, 1}));
}

TEST(AheadDrawer, TheCallerHelpsToDrawThePictureThatItWaitsFor) {
  SharedPicture* shared = nullptr;
  AheadDrawer drawer(1, [&](std::size_t, const PictureKey&, const Snapshot&) -> uav::Sample {
    shared->draw();
    return uav::RangeSample{};
  });
  SharedPicture picture(drawer);
  shared = &picture;
  drawer.expect(key(1), {});
  picture.await_first_part();
  EXPECT_TRUE(drawer.take(key(1)).has_value());
  EXPECT_EQ(picture.times(), (std::array{1, 1}));
}

TEST(AheadDrawer, ThrowsTheErrorOfAPart) {
  AheadDrawer drawer(2, [](std::size_t, const PictureKey&, const Snapshot&) -> uav::Sample {
    return uav::RangeSample{};
  });
  std::atomic<int> parts = 0;
  const auto draw = [&](int part) {
    ++parts;
    if (part == 4) throw Error(ErrorCode::kSetup, "lost");
  };
  EXPECT_STREQ(thrown_error(ErrorCode::kSetup, [&] { drawer.share(5, draw); }).what(), "lost");
  EXPECT_EQ(parts, 5);
}

TEST_F(AheadDrawerTest, ThrowsTheErrorOfTheThread) {
  begin(kFails);
  open(kFails);
  EXPECT_STREQ(thrown_error(ErrorCode::kSetup, [&] { take(kFails); }).what(), "lost");
}

TEST_F(AheadDrawerTest, KeepsTwoPicturesOfASensor) {
  begin(1);
  expect(2);
  expect(3);
  expect(4, 1);
  for (const std::uint64_t index : {1u, 2u, 4u}) open(index);
  EXPECT_EQ(take(1), 1.0);
  gates_[4].has_begun.acquire();
  EXPECT_EQ(take(4, 1), 4.0);
  EXPECT_EQ(take(2), 2.0);
  EXPECT_EQ(take(3), 0.0);
}

TEST_F(AheadDrawerTest, ResetDropsEveryPicture) {
  begin(1);
  expect(2);
  open(1);
  open(2);  // which the thread may have begun
  drawer_.reset();
  EXPECT_EQ(drawer_.work(), SimulatorWork{});
  EXPECT_EQ(take(2), 0.0);
  EXPECT_EQ(take(1), 0.0);
}

}  // namespace
}  // namespace tether::sim
