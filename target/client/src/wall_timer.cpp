#include "wall_timer.h"

#include <cerrno>

#include <time.h>

namespace tether::client {
namespace {

class SystemWallTimer final : public WallTimer {
 public:
  Duration now() const override {
    timespec t{};
    ::clock_gettime(CLOCK_MONOTONIC, &t);
    return std::chrono::seconds(t.tv_sec) + Duration(t.tv_nsec);
  }
  void sleep_until(Duration instant) override {
    if (instant <= now()) return;
    const timespec t{instant.count() / 1'000'000'000, instant.count() % 1'000'000'000};
    while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
    }
  }
};

}  // namespace

std::unique_ptr<WallTimer> make_wall_timer() {
  return std::make_unique<SystemWallTimer>();
}

}  // namespace tether::client
