#include <exception>
#include <tuple>

#include <tether/sim_gazebo_plugin/session.h>

namespace tether::gazebo_plugin {
namespace {

uav::Pose pose_of(const uav::BodyState& body) {
  return {body.p_WB, body.q_WB};
}

// The mean over a step of length `dt_s`.
protocol::Motion motion_between(const uav::BodyState& before, const uav::BodyState& after,
                                double dt_s) {
  return {(1.0 / dt_s) * (after.v_WB - before.v_WB), (1.0 / dt_s) * (after.w_WB_B - before.w_WB_B)};
}

}  // namespace

bool Session::needs_step() const {
  return phase_ == Phase::kWarmingUp || phase_ == Phase::kOver || steps_left_ > 0;
}

void Session::at_step_boundary() {
  try {
    go_on();
  } catch (const std::exception& error) {
    refuse(error.what());
  }
}

void Session::go_on() {
  if (phase_ == Phase::kWarmingUp) warm_up();
  if (advancing_) note_touches();
  if (advancing_ && steps_left_ == 0) finish_advance();
  while (!needs_step()) serve();
  if (steps_left_ > 0 && phase_ == Phase::kServing) begin_step();
}

void Session::serve() {
  const std::optional<protocol::Request> request = host_.next();
  if (!request) {
    phase_ = Phase::kOver;
    return;
  }
  std::visit([this](const auto& what) { handle(what); }, *request);
}

void Session::refuse(const std::string& why) {
  phase_ = Phase::kOver;
  host_.answer(protocol::Failed{why});
}

void Session::handle(const protocol::Open& open) {
  open_ = open;
  flights_ = Flights(open);
  simulation_.open(open);
  phase_ = Phase::kWarmingUp;
}

void Session::warm_up() {
  if (!simulation_.is_ready()) return;
  phase_ = Phase::kServing;
  reset(0);
  host_.answer(protocol::Opened{simulation_.description(), state(), true, true});
}

void Session::reset(std::uint64_t seed) {
  simulation_.reset(seed);
  flights_.reset();
  now_ = {};
  past_.clear();
  touches_.clear();
  motions_.assign(flights_.size(), {});
}

void Session::handle(const protocol::Reset& wanted) {
  reset(wanted.seed);
  host_.answer(state());
}

void Session::handle(const protocol::Advance& advance) {
  for (const protocol::Command& command : advance.commands) {
    flights_.set_setpoint(command.uav, to_setpoint(command.command));
  }
  for (const auto& [uav, setpoint] : advance.setpoints) flights_.set_setpoint(uav, setpoint);
  past_.clear();
  touches_.clear();
  steps_left_ = (advance.to - now_) / open_.step;
  advancing_ = true;
  if (steps_left_ == 0) finish_advance();
}

// Those of the last step, at its beginning: the engine has acted on the velocities since.
void Session::note_touches() {
  if (before_.empty()) return;
  for (const TouchedPoint& point : simulation_.touched_points()) {
    const auto& [first, second] = point.sides;
    const uav::Vec3 apart = velocity_before(first, point.p_W) - velocity_before(second, point.p_W);
    const double speed_m_s = -dot(point.normal_W, apart);
    for (const auto& [own, other] : {std::tie(first, second), std::tie(second, first)}) {
      if (!own.body || *own.body >= flights_.size()) continue;
      touches_.push_back({now_ - open_.step, static_cast<std::uint32_t>(*own.body), other.model,
                          other.shape, speed_m_s});
    }
  }
}

uav::Vec3 Session::velocity_before(const TouchedPoint::Side& side, const uav::Vec3& p_W) const {
  if (!side.body) return {};
  const uav::BodyState& body = before_[*side.body];
  return body.v_WB + cross(rotate(body.q_WB, body.w_WB_B), p_W - body.p_WB);
}

void Session::finish_advance() {
  advancing_ = false;
  if (!before_.empty()) {
    const std::vector<uav::BodyState> after = simulation_.bodies();
    for (std::size_t i = 0; i < flights_.size(); ++i) {
      motions_[i] = motion_between(before_[i], after[i], to_seconds(open_.step));
    }
    before_.clear();
  }
  host_.answer(state());
}

void Session::begin_step() {
  std::vector<uav::BodyState> bodies = simulation_.bodies();
  for (std::size_t i = 0; i < flights_.size(); ++i) {
    const uav::Wrench wrench = flights_.step(i, bodies[i]);
    simulation_.push(i, rotate(bodies[i].q_WB, wrench.force_B),
                     rotate(bodies[i].q_WB, wrench.torque_B));
  }
  if (steps_left_ <= open_.past_steps) {
    past_.emplace_back();
    for (const uav::BodyState& body : bodies) past_.back().push_back(pose_of(body));
  }
  before_ = std::move(bodies);
  now_ += open_.step;
  --steps_left_;
}

protocol::State Session::state() const {
  protocol::State state{now_, simulation_.bodies(), motions_, {}, touches_};
  for (const std::vector<uav::Pose>& poses : past_) {
    state.past.insert(state.past.end(), poses.begin(), poses.end());
  }
  return state;
}

void Session::handle(const protocol::CastRays& rays) {
  host_.answer(simulation_.cast(rays));
}

void Session::handle(const protocol::Render& view) {
  host_.answer(simulation_.render(view));
}

}  // namespace tether::gazebo_plugin
