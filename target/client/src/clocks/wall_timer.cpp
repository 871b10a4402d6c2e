#include "clocks/wall_timer.h"

#include <tether/os/machine.h>

namespace tether::client {
namespace {

class SystemWallTimer final : public WallTimer {
 public:
  Duration now() const override { return os::read_clock(CLOCK_MONOTONIC); }
  void sleep_until(Duration instant) override { os::sleep_until(instant); }
};

}  // namespace

std::unique_ptr<WallTimer> make_wall_timer() {
  return std::make_unique<SystemWallTimer>();
}

}  // namespace tether::client
