// A Simulator whose dynamics run at the other end of a RemoteSession. Advances are split and sent
// with pending commands; each returned state is checked and recorded. The sensing library makes the
// samples from remote rays and pictures.

#include "checked_state.h"
#include "open_request.h"
#include "remote_sensing.h"
#include "remote_session.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <tether/base/error.h>
#include <tether/base/text.h>
#include <tether/sim/bodies.h>
#include <tether/sim_remote/remote_simulator.h>
#include <tether/sim_sensing/sensor_suite.h>
#include <tether/sim_sensing/state_layout.h>
#include <tether/sim_sensing/view_renderer.h>

namespace tether::sim {
namespace {

/// Longer advances are split, so that a slow simulator answers in time and only a hung one does
/// not.
constexpr Duration kLongestAdvance = std::chrono::milliseconds(50);

class RemoteSimulator final : public Simulator {
 public:
  RemoteSimulator(World world, std::unique_ptr<protocol::Connection> connection,
                  RemoteOptions options, WarningSink warn)
      : world_(std::move(world)),
        grid_(world_.step),
        session_(std::move(connection), std::move(options)),
        rays_(session_),
        recorder_(world_),
        meter_(world_, {}),
        sensors_(world_, back_end(), warn),
        commands_(world_.uavs.size()),
        warn_(std::move(warn)) {
    protocol::Opened opened = session_.open(make_open(world_, warn_));
    description_ = printable(opened.description);
    reports_contacts_ = opened.reports_contacts;
    takes_setpoints_ = opened.takes_setpoints;
    meter_.warn_of_starts(warn_);
    session_.set_name(description_);
    if (!takes_setpoints_)
      warn_({Consequence::kNoEffect,
             {},
             "simulator",
             "takes velocities in the heading frame only; other set-points are refused"});
    start_at(std::move(opened.state));
  }

  const World& world() const override { return world_; }
  StepGrid grid() const override { return grid_; }
  SimTime now() const override { return state_.now; }

  void reset(std::uint64_t seed) override {
    start_at(session_.ask<protocol::State>(protocol::Reset{seed}));
    sensors_.reset(seed);
    std::fill(commands_.begin(), commands_.end(), std::nullopt);
  }

  void advance_to(SimTime t) override {
    check_target(t);
    while (now() < t) advance_piece(std::min(t, now() + longest_advance()));
    meter_.warn_of_falls(X_WB_, warn_);
  }

  bool takes_setpoints() const override { return takes_setpoints_; }
  void apply(std::size_t uav, const uav::Setpoint& setpoint) override {
    check_uav(uav);
    if (setpoint.has(uav::kJoints)) recorder_.joints().command(uav, setpoint.joints_rad);
    if (setpoint.flies()) commands_[uav] = flight_of(setpoint);
  }

  void capture(Snapshot& snapshot) const override {
    snapshot.at = now();
    recorder_.capture(X_WB_, motions_, snapshot.state);
  }

  uav::Sample measure(const Snapshot& snapshot, std::size_t uav, std::size_t sensor,
                      std::uint64_t index) override {
    return sensors_.measure(snapshot, uav, sensor, index);
  }

  GroundTruth ground_truth(std::size_t uav) const override {
    check_uav(uav);
    const auto joints_rad = recorder_.joints().angles_rad(uav);
    return {now(), state_.bodies[uav], {joints_rad.begin(), joints_rad.end()}};
  }

  bool reports_contacts() const override { return reports_contacts_; }
  std::vector<Contact> take_contacts() override { return contacts_.take(); }
  std::optional<Clearance> clearance(std::size_t uav) const override {
    check_uav(uav);
    return meter_.measure(uav, X_WB_);
  }

  std::optional<int> walls_between(std::size_t uav, std::size_t other) override {
    check_uav(std::max(uav, other));
    capture(between_);
    return sensors_.walls_between(between_, uav, other);
  }

  std::string description() const override {
    const std::string renderer = sensors_.renderer_name();
    return renderer.empty() ? description_ : description_ + ", " + renderer;
  }

 private:
  SensorSuite::BackEnd back_end() {
    auto make_renderer = [this, radii_m = drawn_radii_m(world_)](raster::Helpers* /*helpers*/) {
      return make_composite_renderer(std::make_unique<RemoteRenderer>(session_), radii_m);
    };
    return {rays_, std::move(make_renderer)};
  }

  // At least one step.
  Duration longest_advance() const {
    return std::max<std::int64_t>(kLongestAdvance / grid_.dt(), 1) * grid_.dt();
  }

  void advance_piece(SimTime t) {
    protocol::Advance request{t, {}};
    for (std::size_t i = 0; i < commands_.size(); ++i) {
      if (!commands_[i]) continue;
      const auto uav = static_cast<std::uint32_t>(i);
      if (const auto velocity = heading_velocity(*commands_[i]))
        request.commands.push_back({uav, *velocity});
      else
        request.setpoints.push_back({uav, *commands_[i]});
      commands_[i].reset();
    }
    const std::int64_t steps = (t - now()) / grid_.dt();
    take(session_.ask<protocol::State>(request));
    for (const protocol::Touch& touch : state_.touches) log_touch(touch);
    const std::size_t bodies = X_WB_.size();
    const auto recorded = static_cast<std::int64_t>(state_.past.size() / bodies);
    for (std::int64_t i = recorded; i < steps; ++i) recorder_.joints().step();
    for (std::size_t i = 0; i < state_.past.size(); i += bodies) {
      recorder_.begin_step(std::span(state_.past).subspan(i, bodies));
    }
  }

  // The log refers to the name.
  void log_touch(const protocol::Touch& touch) {
    if (!reports_contacts_) return;
    const std::string& with = *touched_.insert(printable(touch.with)).first;
    contacts_.add({touch.at, touch.uav, with, touch.shape, touch.speed_m_s});
  }

  void start_at(protocol::State state) {
    contacts_.reset();
    take(std::move(state));
    check_start(world_, state_, session_.name());
    recorder_.reset(X_WB_);
  }

  void take(protocol::State state) {
    state_ = std::move(state);
    check_reach(world_, state_, session_.name());
    X_WB_.clear();
    motions_.clear();
    for (const uav::BodyState& body : state_.bodies) X_WB_.push_back({body.p_WB, body.q_WB});
    for (std::size_t i = 0; i < state_.motions.size(); ++i) {
      const protocol::Motion& motion = state_.motions[i];
      const uav::BodyState& body = state_.bodies[i];
      motions_.push_back({body.w_WB_B, motion.a_WB_W, motion.alpha_WB_B, body.v_WB});
    }
  }

  void check_target(SimTime t) const {
    if (t < now() || !grid_.contains(t)) {
      throw Error(ErrorCode::kInternal, "simulator: cannot advance from " +
                                            std::to_string(to_ns(now())) + " ns to " +
                                            std::to_string(to_ns(t)) + " ns");
    }
  }

  void check_uav(std::size_t uav) const {
    if (uav >= world_.uavs.size()) {
      throw Error(ErrorCode::kInternal, "simulator: no UAV " + std::to_string(uav));
    }
  }

  World world_;
  StepGrid grid_;
  RemoteSession session_;
  RemoteRays rays_;
  StateRecorder recorder_;
  ClearanceMeter meter_;
  bool reports_contacts_ = false;
  bool takes_setpoints_ = false;
  ContactLog contacts_;
  std::set<std::string> touched_;  // names
  SensorSuite sensors_;
  std::string description_;
  /// Not sent yet.
  std::vector<std::optional<uav::Setpoint>> commands_;
  WarningSink warn_;
  Snapshot between_;  // reused
  protocol::State state_;
  std::vector<uav::Pose> X_WB_;
  std::vector<BodyMotion> motions_;
};

}  // namespace

std::unique_ptr<Simulator> make_remote_simulator(World world,
                                                 std::unique_ptr<protocol::Connection> connection,
                                                 RemoteOptions options, const WarningSink& warn) {
  return std::make_unique<RemoteSimulator>(std::move(world), std::move(connection),
                                           std::move(options), printable_warnings(warn));
}

}  // namespace tether::sim
