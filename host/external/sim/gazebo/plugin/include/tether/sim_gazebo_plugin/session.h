#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <tether/sim_protocol/connection.h>
#include <tether/sim_protocol/messages.h>
#include <tether/uav/multirotor.h>

namespace tether::gazebo_plugin {

/// Jobs of the thread of the physics for the only thread that may draw.
class MainThread {
 public:
  /// `wake` makes the main thread call `do_jobs` soon; called repeatedly until it has.
  explicit MainThread(std::function<void()> wake) : wake_(std::move(wake)) {}

  /// Runs `job` there, waits for its end, and throws its exception. False: `give_up`, called about
  /// ten times a second, returned true before the job began.
  bool run(const std::function<void()>& job, const std::function<bool()>& give_up);
  /// To be called in the main thread whenever it may draw.
  void do_jobs();

 private:
  std::function<void()> wake_;
  std::mutex mutex_;
  std::condition_variable done_;
  const std::function<void()>* job_ = nullptr;
  bool running_ = false;
  std::exception_ptr error_;
};

/// The SDF of a UAV with an inactive camera sensor added to its only link: Gazebo maintains a scene
/// only for a world with a camera. Unchanged without a link.
std::string with_idle_camera(const std::string& sdf);

namespace protocol = sim::protocol;

/// Two shapes that touch, at one point. The numbers of bodies are as in `Simulation::bodies`.
struct TouchedPoint {
  struct Side {
    std::optional<std::size_t> body;  ///< none: it does not move
    std::string model;
    std::uint32_t shape = 0;  ///< a number of its own in the world
  };
  Side sides[2];
  uav::Vec3 p_W;
  uav::Vec3 normal_W;  ///< unit, from the second to the first
};

/// The simulator of a session. Every function may throw Error, whose message is sent to the host;
/// after that no function is called.
class Simulation {
 public:
  virtual ~Simulation() = default;
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Begins to put the UAVs into the world.
  virtual void open(const protocol::Open& open) = 0;
  /// Whether the world is ready for `reset`. Called before each step until it is.
  virtual bool is_ready() = 0;
  /// Name and version, for the record.
  virtual std::string description() const = 0;

  /// Back to the state before the first step.
  virtual void reset(std::uint64_t seed) = 0;
  /// Of the UAVs, then of the other moving bodies.
  virtual std::vector<uav::BodyState> bodies() const = 0;
  /// Force and torque on a UAV's centre of mass during the next step [N, N m].
  virtual void push(std::size_t uav, const uav::Vec3& force_W, const uav::Vec3& torque_W) = 0;

  /// Of anything, at the beginning of the last step.
  virtual std::vector<TouchedPoint> touched_points() const = 0;

  virtual protocol::Distances cast(const protocol::CastRays& rays) = 0;
  virtual protocol::Picture render(const protocol::Render& view) = 0;

 protected:
  Simulation() = default;
};

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

/// How a conversation ended. `wrong` is empty if the host left between two requests.
struct End {
  std::string wrong;
};

/// The conversation with the only host of a world. A separate thread receives, so that a host that
/// leaves is noticed while the world is busy.
class HostLine : public Host {
 public:
  /// `on_end` is called once, on that thread, unless the line is destroyed before.
  HostLine(std::unique_ptr<protocol::Listener> listener, std::function<void(const End&)> on_end);
  ~HostLine() override;

  std::optional<protocol::Request> next() override;
  /// A reply that `validate` refuses becomes a Failed with the reason, and ends the conversation.
  void answer(const protocol::Reply& reply) override;
  /// From now on `next` returns none. Any thread, also signal handlers.
  void stop() { stopped_ = true; }
  bool is_stopped() const { return stopped_; }

 private:
  Status send(const protocol::Reply& reply);
  void lose_host();
  void listen();
  std::string converse(protocol::Connection& connection);

  std::unique_ptr<protocol::Listener> listener_;
  std::function<void(const End&)> on_end_;
  std::atomic<bool> stopped_{false};
  std::atomic<bool> closing_{false};

  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<protocol::Connection> connection_;  // shared: each thread uses it until its end
  std::optional<protocol::Request> request_;
  bool answered_ = true;
  std::string failure_;  // that was sent to the host

  std::thread thread_;
};

}  // namespace tether::gazebo_plugin
