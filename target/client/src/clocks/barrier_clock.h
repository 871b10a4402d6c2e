#pragma once

#include "clocks/interaction_clock.h"

#include <mutex>

#include <tether/client/sut_clock.h>

namespace tether::client {

/// Time under the barrier: ET is stopped during an interaction.
class BarrierClock final : public InteractionClock {
 public:
  BarrierClock(const TimeSource& source, ExecTime start) : clock_(source, start) {}

  ExecTime now() const override;
  ExecTime begin() override;
  void end(ExecTime at) override;
  std::optional<ExecTime> while_computing() const override;

 private:
  mutable std::mutex mutex_;  // held for a clock reading only: waiting for it is time of the SUT
  SutClock clock_;
};

}  // namespace tether::client
