#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include <tether/sim_gazebo_plugin/simulation.h>
#include <tether/sim_protocol/messages.h>
#include <tether/uav/multirotor.h>

namespace tether::gazebo_plugin {

/// Rotors and controllers of the UAVs: the same multirotor as in every other simulator.
class Flights {
 public:
  Flights() = default;
  explicit Flights(const sim::protocol::Open& open);

  std::size_t size() const { return flights_.size(); }
  /// Hovering at the start poses, without a set-point.
  void reset();
  void set_setpoint(std::size_t uav, const uav::Setpoint& setpoint);
  /// One step of a UAV, with its body at the beginning of the step.
  uav::Wrench step(std::size_t uav, const uav::BodyState& body);

 private:
  struct Flight {
    uav::Multirotor multirotor;
    double start_yaw_rad = 0.0;
    uav::Setpoint setpoint;
    uav::MultirotorState state;
  };

  double gravity_m_s2_ = 0.0;
  std::vector<Flight> flights_;
};

/// Provides requests and receives the answers.
class Host {
 public:
  virtual ~Host() = default;
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  /// Blocks until there is a request that fits the conversation. None: the conversation is over.
  virtual std::optional<protocol::Request> next() = 0;
  virtual void answer(const protocol::Reply& reply) = 0;

 protected:
  Host() = default;
};

/// Serves a host's requests in step with a world that another program runs: it calls
/// `at_step_boundary` before each step, and the world is stopped until that returns.
///
/// One thread.
class Session {
 public:
  /// Both must outlive it.
  Session(Host& host, Simulation& simulation) : host_(host), simulation_(simulation) {}

  /// Serves requests until one needs a step of the world.
  void at_step_boundary();
  /// There will be no more requests; the world may continue freely.
  bool is_over() const { return phase_ == Phase::kOver; }

 private:
  enum class Phase { kAwaitingOpen, kWarmingUp, kServing, kOver };

  bool needs_step() const;
  void go_on();
  void serve();
  void warm_up();
  void finish_advance();
  void note_touches();
  uav::Vec3 velocity_before(const TouchedPoint::Side& side, const uav::Vec3& p_W) const;
  void begin_step();
  void refuse(const std::string& why);
  void reset(std::uint64_t seed);
  protocol::State state() const;

  void handle(const protocol::Open& open);
  void handle(const protocol::Reset& wanted);
  void handle(const protocol::Advance& advance);
  void handle(const protocol::CastRays& rays);
  void handle(const protocol::Render& view);

  Host& host_;
  Simulation& simulation_;
  Phase phase_ = Phase::kAwaitingOpen;
  protocol::Open open_;
  Flights flights_;
  SimTime now_;
  std::int64_t steps_left_ = 0;
  bool advancing_ = false;
  /// The bodies at the beginning of the last step, and the motion of that step.
  std::vector<uav::BodyState> before_;
  std::vector<protocol::Motion> motions_;
  /// The bodies' poses when the last steps began, all bodies of a step after one another.
  std::deque<std::vector<uav::Pose>> past_;
  std::vector<protocol::Touch> touches_;  ///< of this advance
};

}  // namespace tether::gazebo_plugin
