#pragma once

#include "coordinator_fixture.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

/// For tests of flight controllers and their companions.
namespace tether::coordinator {

using std::chrono::microseconds;
using std::chrono::milliseconds;

inline autopilot::Bytes bytes_of(std::uint64_t number, std::size_t size = 8) {
  autopilot::Bytes bytes(std::max<std::size_t>(size, 8), 0);
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}
inline std::uint64_t number_of(const std::vector<std::uint8_t>& bytes) {
  std::uint64_t number = 0;
  std::memcpy(&number, bytes.data(), std::min(bytes.size(), sizeof number));
  return number;
}

/// What a controller has taken, and when.
struct Taken {
  SimTime at;
  std::uint64_t number = 0;
};
inline constexpr std::uint64_t kEcho = std::uint64_t{1} << 32;

/// Sends back what it has taken, and so many numbers of its own at each step.
class Echo final : public autopilot::FlightController {
 public:
  Echo(std::vector<Taken>& taken, std::uint64_t own, std::size_t size)
      : taken_(&taken), own_(own), size_(size) {
    taken_->clear();
  }
  autopilot::Actions step(const autopilot::Sensed& sensed,
                          const std::vector<autopilot::Bytes>& received) override {
    autopilot::Actions actions;
    for (const autopilot::Bytes& bytes : received) {
      taken_->push_back({sensed.at, number_of(bytes)});
      actions.sent.push_back(bytes_of(kEcho + number_of(bytes), size_));
    }
    for (std::uint64_t i = 0; i < own_; ++i) actions.sent.push_back(bytes_of(++count_, size_));
    actions.setpoint = uav::Setpoint{.velocity_m_s = {static_cast<double>(taken_->size()), 0, 0}};
    return actions;
  }

 private:
  std::vector<Taken>* taken_;
  std::uint64_t own_, count_ = 0;
  std::size_t size_;
};

inline Act to_controller(Duration compute, std::uint64_t number, std::size_t size = 8) {
  return {compute, link::SendMessage{link::kAutopilot, bytes_of(number, size)}};
}

class ControllerLinksTest : public CoordinatorTest {
 protected:
  struct Link {
    Duration period = milliseconds(4);
    Duration latency{0};
    double baud = 0.0;
    std::uint64_t own = 1;
    std::size_t size = 8;  // of what the controller sends
  };
  void make_links(std::size_t uavs, const Link& link, std::size_t without = 0) {
    make(uavs + without);
    taken_.resize(uavs);
    for (std::size_t i = 0; i < uavs; ++i)
      options_.uavs[i].controller = ControllerOptions{
          .name = "echo",
          .estimate = "truth",
          .make = [this, i,
                   link] { return std::make_unique<Echo>(taken_[i], link.own, link.size); },
          .period = link.period,
          .link_baud = link.baud,
          .link_latency = link.latency};
    remake();
  }
  std::vector<std::uint64_t> numbers_taken(std::size_t uav) const {
    std::vector<std::uint64_t> numbers;
    for (const Taken& taken : taken_[uav]) numbers.push_back(taken.number);
    return numbers;
  }

  std::vector<std::vector<Taken>> taken_;
};

}  // namespace tether::coordinator
