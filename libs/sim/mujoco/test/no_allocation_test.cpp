#include "test_simulator.h"

#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>
#include <malloc.h>

// Sanitizers bring their own allocator; there is nothing to count then.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {

std::atomic<bool> counting = false;
std::atomic<long> allocations = 0;

void count() {
  if (counting) ++allocations;
}

}  // namespace

// Everything that a program allocates with goes through these, the engine included.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  count();
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  count();
  return __libc_calloc(number, size);
}
void* realloc(void* old, std::size_t size) {
  count();
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count();
  return __libc_memalign(alignment, size);
}
}

namespace tether::sim {
namespace {

using namespace std::chrono_literals;

TEST(NoAllocationTest, CountsAllocations) {
  counting = true;
  const auto buffer = std::make_unique<std::vector<int>>(100);
  counting = false;
  EXPECT_EQ(buffer->size(), 100U);
  EXPECT_GE(allocations.exchange(0), 2);
}

class SteppingTest : public ::testing::TestWithParam<double> {};

// With a shutter, every step is remembered.
TEST_P(SteppingTest, SteppingAndCapturingAllocateNothing) {
  World world = testing::test_world();
  world.models.push_back(
      testing::box_model("wall", {1.0, 0.0, 1.0}, {0.2, 4.0, 3.0}, {1.0, 1.0, 1.0}));
  std::get<CameraModel>(world.uavs[0].sensors[testing::kCamera].model).readout_s = GetParam();
  const auto simulator = testing::make_simulator(world);
  Snapshot snapshot;
  simulator->capture(snapshot);
  counting = true;
  simulator->apply(0, {{1.0, 0.0, 0.0}, 0.3});
  simulator->advance_to(SimTime(3s));  // into the wall
  simulator->capture(snapshot);
  simulator->ground_truth(0);
  simulator->reset(2);
  simulator->capture(snapshot);
  simulator->advance_to(SimTime(100ms));
  counting = false;
  EXPECT_EQ(allocations.exchange(0), 0);
}

INSTANTIATE_TEST_SUITE_P(Readout_s, SteppingTest, ::testing::Values(0.0, 0.03));

}  // namespace
}  // namespace tether::sim

#endif
