#include "gazebo_simulation.h"
#include "shutdown.h"

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include <gazebo/common/Events.hh>
#include <gazebo/common/Plugin.hh>
#include <gazebo/physics/physics.hh>
#include <gazebo/rendering/rendering.hh>

#include <tether/sim_gazebo_plugin/session.h>
#include <tether/sim_protocol/connection.h>

namespace tether::gazebo_plugin {
namespace {

constexpr const char* kEndpoint = "TETHER_SIMULATOR_ENDPOINT";

// Gazebo catches no exception of a plugin, and continues without a plugin that fails to load.
[[noreturn]] void give_up(const std::string& why) {
  std::fprintf(stderr, "tether: %s\n", why.c_str());
  std::fflush(nullptr);
  std::_Exit(EXIT_FAILURE);
}

template <class T>
T or_give_up(Result<T> result) {
  if (!result) give_up(result.failure().message);
  return std::move(*result);
}

std::unique_ptr<protocol::Listener> listen() {
  const char* text = std::getenv(kEndpoint);
  if (!text) {
    give_up(std::string(kEndpoint) +
            " is not set; set it to the address for Tether, such as unix:/tmp/gazebo.sock");
  }
  auto listener = or_give_up(protocol::listen(or_give_up(protocol::parse_endpoint(text))));
  std::printf("tether: listening on %s\n", protocol::to_string(listener->endpoint()).c_str());
  std::fflush(stdout);
  return listener;
}

// Wakes Gazebo's main thread by a message without a pose.
void wake_main_thread(const ::gazebo::physics::WorldPtr& world) {
  ::gazebo::msgs::PosesStamped nothing;
  ::gazebo::msgs::Set(nothing.mutable_time(), world->SimTime());
  ::gazebo::rendering::update_scene_poses(world->Name(), nothing);
}

}  // namespace

/// The simulator's end of the protocol, in gzserver: `gzserver --lockstep -s libtether_gazebo.so
/// WORLD`, with the address to listen on in TETHER_SIMULATOR_ENDPOINT. It attaches to any world
/// that is loaded, so that users' world files need no change.
class Plugin : public ::gazebo::SystemPlugin {
 public:
  void Load(int, char**) override {
    using ::gazebo::event::Events;
    line_ = std::make_unique<HostLine>(listen(), [](const End& end) { shut_down(end.wrong); });
    events_ = {
        Events::ConnectWorldCreated([this](const std::string& name) { attach(name); }),
        Events::ConnectWorldUpdateBegin([this](const ::gazebo::common::UpdateInfo&) { step(); }),
        Events::ConnectRender([this] { main_thread_.do_jobs(); }),
        Events::ConnectSigInt([this] { line_->stop(); }),
    };
  }

 private:
  void attach(const std::string& world_name) {
    if (world_) return;
    world_ = ::gazebo::physics::get_world(world_name);
    simulation_.emplace(world_, main_thread_, [this] { return line_->is_stopped(); });
    session_.emplace(*line_, *simulation_);
  }

  // Before a step of the world, in the thread of its physics.
  void step() {
    if (session_) session_->at_step_boundary();
  }

  std::unique_ptr<HostLine> line_;
  ::gazebo::physics::WorldPtr world_;
  MainThread main_thread_{[this] { wake_main_thread(world_); }};
  std::optional<GazeboSimulation> simulation_;
  std::optional<Session> session_;
  std::vector<::gazebo::event::ConnectionPtr> events_;
};

GZ_REGISTER_SYSTEM_PLUGIN(Plugin)

}  // namespace tether::gazebo_plugin
