#include "clip.h"
#include "shadow_map.h"
#include "strip_renderer.h"
#include "test_scenes.h"
#include "transform.h"
#include "worker_pool.h"

#include <atomic>
#include <stdexcept>

#include <gmock/gmock.h>

namespace tether::raster {
namespace {

TEST(Clip, LeavesWhatIsBeyondTheNearPlane) {
  Polygon polygon;
  polygon.add({{0.0, 0.0, -1.0}, {0, 0}, false});
  polygon.add({{1.0, 0.0, 3.0}, {0, 0}, false});
  polygon.add({{-1.0, 0.5, 3.0}, {0, 0}, false});
  clip(polygon, {100.0, 100.0, 50.0, 50.0, 1.0});
  ASSERT_EQ(polygon.size, 4U);
  for (std::size_t i = 0; i < polygon.size; ++i) {
    EXPECT_GE(polygon.points[i].p_C.z, 1.0 - 1e-12);
  }
}

TEST(Clip, LeavesNothingOfWhatIsBehind) {
  Polygon polygon;
  for (int i = 0; i < 3; ++i) polygon.add({{1.0 * i, 1.0, -1.0 - i}, {0, 0}, false});
  clip(polygon, {100.0, 100.0, 50.0, 50.0, 1.0});
  EXPECT_LT(polygon.size, 3U);
}

TEST(WorkerPool, DoesEachJobOnce) {
  for (const int workers : {1, 2, 5}) {
    WorkerPool pool(workers);
    EXPECT_EQ(pool.workers(), workers);
    for (int round = 0; round < 20; ++round) {
      std::vector<std::atomic<int>> done(37);
      pool.run(37, [&](int worker, int job) {
        EXPECT_TRUE(worker >= 0 && worker < workers);
        ++done[static_cast<std::size_t>(job)];
      });
      for (const auto& times : done) EXPECT_EQ(times, 1);
    }
  }
}

TEST(WorkerPool, ThrowsWhatAJobThrows) {
  WorkerPool pool(3);
  EXPECT_THROW(pool.run(9,
                        [](int, int job) {
                          if (job == 4) throw std::runtime_error("job 4");
                        }),
               std::runtime_error);
  int jobs = 0;
  std::mutex mutex;
  pool.run(5, [&](int, int) {
    const std::lock_guard lock(mutex);
    ++jobs;
  });
  EXPECT_EQ(jobs, 5);
}

}  // namespace
}  // namespace tether::raster
