#include "signals_blocked.h"
#include "vehicle/cancellation.h"

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <tether/client/vehicle.h>

namespace tether::client {
namespace {

/// What the thread and its owner share; the thread may outlive the owner if its callback destroys
/// it.
struct State {
  Cancellation cancellation;
  mutable std::mutex mutex;
  std::optional<Failure> ended;  // guarded by mutex
};

struct Reading {
  Vehicle& vehicle;
  std::string sensor;
  uav::SensorKind kind;
  std::function<void(const uav::Sample&)> on_measurement;
};

void run(State& state, const Reading& reading) {
  const Cancellation::Scope scope(state.cancellation);
  while (!state.cancellation.is_cancelled()) {
    const auto sample = reading.vehicle.read_any(reading.sensor, reading.kind, Read::kNext);
    if (!sample) {
      const std::lock_guard lock(state.mutex);
      state.ended = sample.failure();
      return;
    }
    if (!state.cancellation.is_cancelled()) reading.on_measurement(*sample);
  }
}

class ThreadedSubscription final : public Subscription {
 public:
  explicit ThreadedSubscription(Reading reading) {
    const SignalsBlocked blocked;
    thread_ = std::thread([state = state_, reading = std::move(reading)] { run(*state, reading); });
  }
  ~ThreadedSubscription() override {
    state_->cancellation.cancel();
    if (thread_.get_id() == std::this_thread::get_id()) {
      thread_.detach();
    } else {
      thread_.join();
    }
  }
  std::optional<Failure> ended() const override {
    const std::lock_guard lock(state_->mutex);
    return state_->ended;
  }

 private:
  std::shared_ptr<State> state_ = std::make_shared<State>();
  std::thread thread_;
};

Status check(const Vehicle& vehicle, std::string_view sensor, uav::SensorKind kind) {
  const auto failure = [&](const std::string& why) {
    return Failure{Failure::Kind::kInvalid,
                   "cannot subscribe to '" + std::string(sensor) + "': " + why};
  };
  const auto* found = vehicle.catalogue().find_sensor(sensor);
  if (found == nullptr || found->kind() != kind) {
    return failure("the UAV has no " + std::string(uav::name(kind)) + " of that name");
  }
  if (found->rate_hz <= 0.0) return failure("it measures on demand only");
  if (vehicle.is_concurrent()) return ok_status();
  return failure("subscriptions need tether-exec; start this program with it");
}

}  // namespace

Result<std::unique_ptr<Subscription>> subscribe_any(
    Vehicle& vehicle, std::string_view sensor, uav::SensorKind kind,
    std::function<void(const uav::Sample&)> on_measurement) {
  if (const Status good = check(vehicle, sensor, kind); !good) return good.failure();
  return std::unique_ptr<Subscription>(std::make_unique<ThreadedSubscription>(
      Reading{vehicle, std::string(sensor), kind, std::move(on_measurement)}));
}

}  // namespace tether::client
