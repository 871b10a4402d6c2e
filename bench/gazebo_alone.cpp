#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <gazebo/common/Events.hh>
#include <gazebo/common/Plugin.hh>
#include <gazebo/physics/PhysicsEngine.hh>
#include <gazebo/physics/PhysicsIface.hh>
#include <gazebo/physics/World.hh>
#include <gazebo/rendering/Camera.hh>
#include <gazebo/sensors/CameraSensor.hh>
#include <gazebo/sensors/SensorManager.hh>
#include <unistd.h>

/// The yardstick of bench/gazebo: lets gzserver run as fast as it can, alone, and prints how much
/// it simulated in how much wall time, and how many images its cameras made. Then ends it.
namespace tether::bench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_of(const char* variable, double otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::atof(text) : otherwise;
}

}  // namespace

class GazeboAlone final : public gazebo::SystemPlugin {
 public:
  void Load(int, char**) override {
    step_ = gazebo::event::Events::ConnectWorldUpdateBegin(
        [this](const gazebo::common::UpdateInfo& info) {
          on_step(info.worldName, info.simTime.Double());
        });
  }

 private:
  // The first images are left out: until they come, Gazebo loads, and runs without cameras.
  void on_step(const std::string& world, double simulated_s) {
    if (frames_.empty()) count_frames();
    if (!is_measuring_) gazebo::physics::get_world(world)->Physics()->SetRealTimeUpdateRate(0.0);
    if (!is_measuring_ && images_ >= kFirstImages) {
      is_measuring_ = true;
      begin_s_ = simulated_s;
      images_ = 0;
      began_ = Clock::now();
    }
    if (is_measuring_ && simulated_s >= begin_s_ + length_s_) finish();
  }

  void count_frames() {
    for (const auto& sensor : gazebo::sensors::SensorManager::Instance()->GetSensors()) {
      const auto camera = std::dynamic_pointer_cast<gazebo::sensors::CameraSensor>(sensor);
      if (!camera || !camera->Camera()) continue;
      frames_.push_back(camera->Camera()->ConnectNewImageFrame(
          [this](const unsigned char*, unsigned, unsigned, unsigned, const std::string&) {
            ++images_;
          }));
    }
  }

  void finish() {
    const std::chrono::duration<double> wall = Clock::now() - began_;
    std::printf("simulated_s %.3f wall_s %.4f images %d\n", length_s_, wall.count(),
                images_.load());
    std::fflush(stdout);
    step_.reset();
    kill(getpid(), SIGINT);
  }

  static constexpr int kFirstImages = 10;
  const double length_s_ = seconds_of("TETHER_BENCH_SECONDS", 10.0);
  bool is_measuring_ = false;
  double begin_s_ = 0.0;
  std::atomic<int> images_{0};
  Clock::time_point began_;
  gazebo::event::ConnectionPtr step_;
  std::vector<gazebo::event::ConnectionPtr> frames_;
};

GZ_REGISTER_SYSTEM_PLUGIN(GazeboAlone)

}  // namespace tether::bench
