#include <utility>

#include <signal.h>

#include <tether/rig/device_arguments.h>

namespace tether::rig {
namespace {

volatile sig_atomic_t g_interrupted = 0;

extern "C" void on_interrupt(int /*signal*/) {
  g_interrupted = 1;
}

class InterruptibleVehicle : public client::Vehicle {
 public:
  InterruptibleVehicle(std::unique_ptr<client::Vehicle> vehicle, std::function<bool()> is_over)
      : vehicle_(std::move(vehicle)), is_interrupted_(std::move(is_over)) {}

  ExecTime now() const override { return vehicle_->now(); }
  const uav::Catalogue& catalogue() const override { return vehicle_->catalogue(); }
  bool is_concurrent() const override { return vehicle_->is_concurrent(); }

  Status set_queue(std::string_view sensor, std::uint32_t depth) override {
    return vehicle_->set_queue(sensor, depth);
  }
  Result<uav::Sample> read_any(std::string_view sensor, uav::SensorKind kind,
                               client::Read read) override {
    return unless_interrupted([&] { return vehicle_->read_any(sensor, kind, read); });
  }
  Result<uav::BatterySample> read_battery() override {
    return unless_interrupted([&] { return vehicle_->read_battery(); });
  }
  Status command_velocity(const uav::VelocityCommand& command) override {
    return unless_interrupted([&] { return vehicle_->command_velocity(command); });
  }
  Status follow(std::span<const uav::TimedSetpoint> trajectory) override {
    return unless_interrupted([&] { return vehicle_->follow(trajectory); });
  }
  Status sleep_for(Duration duration) override {
    return unless_interrupted([&] { return vehicle_->sleep_for(duration); });
  }
  Status sleep_until(ExecTime until) override {
    return unless_interrupted([&] { return vehicle_->sleep_until(until); });
  }
  const std::vector<std::string>& peers() const override { return vehicle_->peers(); }
  Status send(std::string_view to, std::span<const std::uint8_t> bytes) override {
    return unless_interrupted([&] { return vehicle_->send(to, bytes); });
  }
  Result<client::RadioMessage> receive(Duration timeout) override {
    return unless_interrupted([&] { return vehicle_->receive(timeout); });
  }
  Status annotate(std::string_view topic, std::string_view json) override {
    return vehicle_->annotate(topic, json);
  }
  Status begin_stage(std::string_view stage) override { return vehicle_->begin_stage(stage); }
  Status end_stage() override { return vehicle_->end_stage(); }
  Status finish(bool reached_goal, std::string_view outcome,
                std::string_view details_json) override {
    return vehicle_->finish(reached_goal, outcome, details_json);
  }

 private:
  template <class Call>
  auto unless_interrupted(Call call) -> decltype(call()) {
    if (is_interrupted_()) return Failure{Failure::Kind::kRunEnded, "interrupted"};
    auto result = call();
    if (!result && is_interrupted_()) return Failure{Failure::Kind::kRunEnded, "interrupted"};
    return result;
  }

  std::unique_ptr<client::Vehicle> vehicle_;
  std::function<bool()> is_interrupted_;
};

}  // namespace

std::unique_ptr<client::Vehicle> make_interruptible(std::unique_ptr<client::Vehicle> vehicle,
                                                    std::function<bool()> is_interrupted) {
  return std::make_unique<InterruptibleVehicle>(std::move(vehicle), std::move(is_interrupted));
}

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  action.sa_flags = 0;
  if (signal(SIGHUP, SIG_IGN) != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
  signal(SIGPIPE, SIG_IGN);
}

bool interrupted() {
  return g_interrupted != 0;
}

}  // namespace tether::rig
