// One step boundary: `sample` takes what sensors are due, then commands take effect, then ground
// truth, contacts and batteries are logged. `next_due` is the next boundary at which any of these
// has something to do; up to there the simulator advances in one call.

#include "stepper.h"

#include <algorithm>
#include <utility>

namespace tether::coordinator {

namespace {

std::vector<record::SeenAnchor> describe(const std::vector<uav::SeenAnchor>& anchors) {
  std::vector<record::SeenAnchor> described;
  for (const auto& [name, left, top, right, bottom, pixels] : anchors)
    described.push_back({name, left, top, right, bottom, static_cast<std::uint64_t>(pixels)});
  return described;
}

}  // namespace

Stepper::Stepper(sim::Simulator& simulator, const Timelines& times, RunLog& log,
                 Duration ground_truth_period, std::vector<Sampler> samplers,
                 const std::vector<std::optional<uav::SetpointLoss>>& losses)
    : simulator_(&simulator),
      times_(&times),
      log_(&log),
      grid_(simulator.grid()),
      ground_truth_period_(ground_truth_period),
      samplers_(std::move(samplers)),
      has_changed_(samplers_.size()),
      commands_(grid_, losses),
      has_battery_(samplers_.size()),
      loads_(samplers_.size()) {
  for (std::size_t uav = 0; uav < samplers_.size(); ++uav) {
    due_.add();
    note_change(uav);
  }
}

void Stepper::reset(std::uint64_t seed) {
  guarded([&](sim::Simulator& s) { s.reset(seed); });
  for (std::size_t uav = 0; uav < samplers_.size(); ++uav)
    has_battery_[uav] = guarded([&](sim::Simulator& s) { return s.battery(uav).has_value(); });
}

SimTime Stepper::next_ground_truth() const {
  return grid_.ceil(SimTime(ground_truths_ * ground_truth_period_));
}

SimTime Stepper::next_due() const {
  SimTime due =
      std::min({commands_.next_effect(), next_ground_truth(), same_instant(due_.least())});
  for (std::size_t uav = 0; uav < loads_.size(); ++uav)
    if (has_battery_[uav]) due = std::min(due, loads_[uav].next_change(st_, grid_));
  return due;
}

void Stepper::advance_to(SimTime to) {
  load_batteries(to);
  guarded([&](sim::Simulator& s) { s.advance_to(to); });
  st_ = to;
  log_->settle();
  act();
  log_->race_again();
}

// Samples come first, so that they do not depend on commands that take effect at this boundary.
void Stepper::act() {
  sample();
  apply_commands();
  log_ground_truth();
}

void Stepper::computes(std::size_t uav, SimTime from, SimTime to, double cores) {
  if (has_battery_[uav]) loads_[uav].add(from, to, cores);
}

void Stepper::begins_computing(std::size_t uav, SimTime at) {
  if (has_battery_[uav]) loads_[uav].begin(at);
}

void Stepper::ends_computing(std::size_t uav, SimTime at) {
  if (has_battery_[uav]) loads_[uav].end(at);
}

// ST does not pass the bound of a SUT that computes, so its load is known up to there.
void Stepper::load_batteries(SimTime to) {
  for (std::size_t uav = 0; uav < loads_.size(); ++uav) {
    if (!has_battery_[uav]) continue;
    const double cores = loads_[uav].mean_cores(st_, to);
    guarded([&](sim::Simulator& s) { s.computing(uav, cores); });
  }
}

std::optional<Stepper::Exhausted> Stepper::exhausted() {
  for (std::size_t uav = 0; uav < has_battery_.size(); ++uav) {
    if (!has_battery_[uav]) continue;
    const auto status = guarded([&](sim::Simulator& s) { return s.battery(uav); });
    if (status && status->empty_at) return Exhausted{uav, *status->empty_at};
  }
  return std::nullopt;
}

// No request of a SUT has a timestamp before its bound.
void Stepper::sample() {
  const Sampler::Capture capture = [this] {
    return states_.at(st_, [this](sim::Snapshot& snapshot) {
      guarded([&](sim::Simulator& s) { s.capture(snapshot); });
    });
  };
  while (same_instant(due_.least()) <= st_) {
    const std::size_t uav = due_.first();
    // A message can end the present call of its SUT at any time from now on.
    const SimTime earliest = std::min(st_, same_instant((*times_)[uav].bound()));
    samplers_[uav].sample(st_, earliest, capture);
    note_change(uav);
  }
}

// After each change of a sampler.
void Stepper::note_change(std::size_t uav) {
  due_.set(uav, same_instant(samplers_[uav].next_due()));
  if (has_changed_[uav]) return;
  has_changed_[uav] = true;
  changed_.push_back(uav);
}

std::optional<Measurement> Stepper::plan(std::size_t uav, std::uint64_t call,
                                         const link::ReadSensor& read, SimTime t) {
  auto measurement = samplers_[uav].plan(call, read, t);
  note_change(uav);
  return measurement;
}

std::optional<std::uint64_t> Stepper::skip(std::size_t uav, const link::ReadSensor& read,
                                           SimTime t) {
  const auto skipped_to = samplers_[uav].skip(read, t);
  note_change(uav);
  return skipped_to;
}

void Stepper::close(std::size_t uav) {
  samplers_[uav].close();
  note_change(uav);
}

void Stepper::apply_commands() {
  while (auto effect = commands_.pop_due(st_)) {
    if (effect->loss) {
      const auto truth = guarded([&](sim::Simulator& s) { return s.ground_truth(effect->uav); });
      effect->setpoint = setpoint_on_loss(*effect->loss, effect->setpoint, truth.body.p_WB);
    }
    guarded([&](sim::Simulator& s) { s.apply(effect->uav, effect->setpoint); });
    log_->command_effect(st_, simulator_->world().uavs[effect->uav].name, *effect);
  }
}

void Stepper::log_ground_truth() {
  if (next_ground_truth() > st_) return;
  ++ground_truths_;
  for (std::size_t uav = 0; uav < samplers_.size(); ++uav) {
    const std::string& name = simulator_->world().uavs[uav].name;
    const auto truth = guarded([&](sim::Simulator& s) { return s.ground_truth(uav); });
    log_->ground_truth(name, truth, guarded([&](sim::Simulator& s) { return s.clearance(uav); }));
    if (!has_battery_[uav]) continue;
    const auto battery = guarded([&](sim::Simulator& s) { return s.battery(uav); });
    if (battery) log_->battery(st_, name, *battery);
  }
  log_contacts();
}

// At the instants of the ground truth and at the end only, which do not depend on the load: how far
// ST advances at once does.
void Stepper::log_contacts() {
  const auto contacts = guarded([](sim::Simulator& s) { return s.take_contacts(); });
  for (const sim::Contact& contact : contacts)
    log_->contact(st_, simulator_->world().uavs[contact.uav].name, contact);
}

std::optional<uav::Sample> Stepper::measure(std::size_t uav, record::Interaction& entry) {
  Sampler& sampler = samplers_[uav];
  const Sampler::Read* read = sampler.find(entry.sequence);
  if (!read) return std::nullopt;
  const sim::Snapshot& state = sampler.state_of(*read);
  entry.sample_state_at = state.at;
  entry.grid_error = std::max(entry.grid_error, read->measurement.sampled_at - state.at);
  auto sample = guarded([&](sim::Simulator& s) {
    return s.measure(state, uav, read->sensor, read->measurement.content());
  });
  if (read->measurement.stamp) {
    std::visit(
        [&](auto& content) {
          content.sampled_at = *read->measurement.stamp;
          content.index = read->measurement.index;
        },
        sample);
  }
  sampler.answered(entry.sequence, same_instant(entry.reply_at));
  note_change(uav);
  if (const auto* image = std::get_if<uav::CameraSample>(&sample)) {
    log_->count_image();
    if (image->knows_anchors) entry.seen_anchors = describe(image->seen_anchors);
  }
  return sample;
}

// A reply goes when ST is at the boundary of its timestamp.
uav::BatterySample Stepper::read_battery(std::size_t uav, record::Interaction& entry) {
  const energy::Status now = *guarded([&](sim::Simulator& s) { return s.battery(uav); });
  entry.battery = {now.voltage_V, now.current_A, now.charge};
  return {st_, now.voltage_V, now.current_A, now.charge};
}

// The noise of its measurements is that of the sensor, with numbers of their own.
autopilot::Sensed Stepper::sense(std::size_t uav, const std::function<std::uint64_t()>& number) {
  autopilot::Sensed sensed{
      .at = st_, .truth = guarded([&](sim::Simulator& s) { return s.ground_truth(uav).body; })};
  if (has_battery_[uav]) {
    const auto battery = guarded([&](sim::Simulator& s) { return s.battery(uav); });
    if (battery)
      sensed.battery =
          uav::BatterySample{st_, battery->voltage_V, battery->current_A, battery->charge};
  }
  sensed.measure = [this, uav, number](uav::SensorKind kind) -> std::optional<uav::Sample> {
    const std::vector<sim::Sensor>& sensors = simulator_->world().uavs[uav].sensors;
    const auto sensor = std::ranges::find(sensors, kind, &sim::Sensor::kind);
    if (sensor == sensors.end()) return std::nullopt;
    return guarded([&](sim::Simulator& s) {
      s.capture(sensed_);
      return s.measure(sensed_, uav, static_cast<std::size_t>(sensor - sensors.begin()), number());
    });
  };
  return sensed;
}

autopilot::Sensed Stepper::sense(std::size_t uav) {
  constexpr std::uint64_t kFirst = std::uint64_t{1} << 40;
  return sense(uav, [this] {
    return kFirst + static_cast<std::uint64_t>(st_.time_since_epoch() / grid_.dt());
  });
}

autopilot::Sensed Stepper::sense_at_rest(std::size_t uav) {
  return sense(uav, [number = std::uint64_t{1} << 39]() mutable { return number++; });
}

void Stepper::fly(std::size_t uav, const uav::Setpoint& setpoint) {
  guarded([&](sim::Simulator& s) { s.apply(uav, setpoint); });
}

radio::Link Stepper::link(std::size_t uav, std::size_t other) {
  return guarded([&](sim::Simulator& s) {
    const uav::Vec3 p_W_m = s.ground_truth(uav).body.p_WB - s.ground_truth(other).body.p_WB;
    const auto walls = s.walls_between(uav, other);
    if (!walls)
      throw Error(ErrorCode::kSetup,
                  "the simulator cannot tell how many walls are between two UAVs; use the radio's "
                  "model \"ideal\", or another simulator");
    return radio::Link{.distance_m = uav::norm(p_W_m), .walls = *walls};
  });
}

void Stepper::announce() {
  for (const std::size_t uav : changed_) {
    has_changed_[uav] = false;
    samplers_[uav].announce(
        [&](const sim::Snapshot& state, std::size_t sensor, std::uint64_t index) {
          guarded([&](sim::Simulator& s) { s.expect(state, uav, sensor, index); });
        });
  }
  changed_.clear();
}

}  // namespace tether::coordinator
