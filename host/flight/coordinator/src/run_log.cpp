// Turns what happened into messages of the record. For a repeatable run, the messages of one ST are
// collected by `put`, which brings them into their order, and written by `settle`; otherwise each
// is written at once. The figures of the footer are counted on the way.

#include "run_log.h"

#include "header_facts.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

#include <tether/record/png.h>

namespace tether::coordinator {

namespace {

/// Errors of the recorder become RecordFailure.
template <class F>
void guarded(F&& f) {
  try {
    f();
  } catch (const Error& e) {
    throw RecordFailure(e.what());
  }
}

}  // namespace

void RunLog::begin(record::Header header, bool repeatable) {
  repeatable_ = repeatable;
  flushed_ = header.wall_at_start;
  for (const record::SutInfo& sut : header.suts) rows_.insert({sut.uav, {rows_.size(), {}}});
  if (repeatable) {
    header.wall_at_start = {};
    header.machine.clear();
    if (header.target) header.target->before.clear();
  }
  guarded([&] { recorder_->write(header); });
}

void RunLog::interaction(SimTime st, record::Interaction entry) {
  ++footer_.interactions;
  if (entry.violation) ++footer_.causality_violations;
  footer_.largest_lag = std::max(footer_.largest_lag, entry.lag);
  footer_.largest_grid_error = std::max(footer_.largest_grid_error, entry.grid_error);
  put(st, std::move(entry));
}

void RunLog::command_effect(SimTime st, const std::string& uav, const CommandEffect& effect) {
  record::CommandEffect message{.uav = uav, .sequence = effect.sequence, .applied_at = st};
  if (const auto velocity = heading_velocity(effect.setpoint)) {
    const auto& [v, yaw_rate] = *velocity;
    std::tie(message.vx_H_m_s, message.vy_H_m_s, message.vz_H_m_s, message.yaw_rate_rad_s) =
        std::tie(v.x, v.y, v.z, yaw_rate);
  } else {
    message.setpoint = record_of(effect.setpoint);
  }
  message.index = effect.index;
  if (effect.loss) message.loss = name(*effect.loss);
  put(st, std::move(message));
}

void RunLog::ground_truth(const std::string& uav, const sim::GroundTruth& truth,
                          const std::optional<sim::Clearance>& clearance) {
  const auto& [p, q, v, w] = truth.body;
  std::optional<double> clearance_m;
  if (clearance) clearance_m = clearance->distance_m;
  put(truth.at, record::GroundTruth{.uav = uav,
                                    .at = truth.at,
                                    .p_WB_m = {p.x, p.y, p.z},
                                    .q_WB = {q.w, q.x, q.y, q.z},
                                    .v_WB_m_s = {v.x, v.y, v.z},
                                    .w_WB_B_rad_s = {w.x, w.y, w.z},
                                    .clearance_m = clearance_m,
                                    .joints_rad = truth.joints_rad});
  if (clearance) take_clearance(truth.at, uav, *clearance);
}

void RunLog::contact(SimTime st, const std::string& uav, const sim::Contact& contact) {
  put(st, record::Contact{
              .uav = uav, .at = contact.at, .with = contact.with, .speed_m_s = contact.speed_m_s});
}

void RunLog::battery(SimTime st, const std::string& uav, const energy::Status& status) {
  const auto& [lift, moving, idle, computing, sensors, resistance] = status.spent_J;
  put(st, record::Battery{.uav = uav,
                          .at = st,
                          .voltage_V = status.voltage_V,
                          .current_A = status.current_A,
                          .charge = status.charge,
                          .lift_J = lift,
                          .moving_J = moving,
                          .idle_J = idle,
                          .computing_J = computing,
                          .sensors_J = sensors,
                          .resistance_J = resistance});
}

void RunLog::take_clearance(SimTime st, const std::string& uav, const sim::Clearance& clearance) {
  auto& least = footer_.clearances;
  const auto [place, is_new] = clearance_at_.try_emplace(uav, least.size());
  if (is_new) least.push_back({uav, std::numeric_limits<double>::infinity(), {}, {}});
  record::Clearance& own = least[place->second];
  if (clearance.distance_m < own.min_m)
    own = {uav, clearance.distance_m, st, std::string(clearance.to)};
}

void RunLog::stop(SimTime st, const record::Stop& stop) {
  ++footer_.stops;
  if (stop.reply_at)
    footer_.largest_overshoot = std::max(footer_.largest_overshoot, stop.at - *stop.reply_at);
  put(st, stop);
}

// Events are handled in the order of time.
void RunLog::in_order(SimTime st, record::Message message) {
  if (collects_)
    in_order_.emplace_back(st, std::move(message));
  else
    guarded([&] { recorder_->write(st, message); });
}

void RunLog::image(SimTime st, const std::string& uav, const std::string& sensor,
                   const uav::CameraSample& sample) {
  if (!sample.rgb.empty()) {
    put(st,
        record::Image{.uav = uav,
                      .sensor = sensor,
                      .at = sample.sampled_at,
                      .index = sample.index,
                      .png = record::encode_png(sample.width_px, sample.height_px, sample.rgb)});
  }
  const auto put_raw = [&](const auto& pixels) {
    if (pixels.empty()) return;
    put(st, record::RawImage{.uav = uav,
                             .sensor = sensor,
                             .at = sample.sampled_at,
                             .index = sample.index,
                             .width_px = sample.width_px,
                             .height_px = sample.height_px,
                             .pixels = pixels});
  };
  put_raw(sample.depth_m);
  put_raw(sample.labels);
}

void RunLog::flush(WallTime now) {
  constexpr Duration kPeriod = std::chrono::seconds(1);
  if (now - flushed_ < kPeriod) return;
  flushed_ = now;
  guarded([&] { recorder_->flush(); });
}

void RunLog::end() {
  settle();
  record::Footer footer = footer_;
  if (repeatable_) {
    footer.wall = {};
    footer.target_after.clear();
  }
  guarded([&] { recorder_->write(footer); });
}

void RunLog::settle() {
  collects_ = false;
  for (Collected& collected : collected_) write(collected.st, collected.message);
  collected_.clear();
  for (const auto& logged : in_order_)
    guarded([&] { recorder_->write(logged.first, logged.second); });
  in_order_.clear();
}

// Inserts the message before those of other SUTs that have a greater key. Those of one SUT stay in
// their order: its key does not decrease.
void RunLog::put(SimTime st, record::Message message) {
  if (!collects_) return write(st, message);
  Row& row = rows_.at(std::visit([](const auto& m) { return m.uav; }, message));
  if (const auto* interaction = std::get_if<record::Interaction>(&message))
    row.reached = std::max(row.reached, interaction->reply_at);
  if (std::holds_alternative<record::CommandEffect>(message))
    row.reached = std::max(row.reached, same_instant(st));
  Collected later{st, {row.reached, row.index}, std::move(message)};
  auto place = collected_.end();
  while (place != collected_.begin() && may_precede(later, *std::prev(place))) --place;
  collected_.insert(place, std::move(later));
}

// A message of another SUT came later, but its place is before. The barrier lets a reply go while a
// SUT computes only if that SUT cannot act before the reply any more, or beyond this ST only.
bool RunLog::may_precede(const Collected& later, const Collected& earlier) {
  if (later.key >= earlier.key) return false;
  const auto* reply = std::get_if<record::Interaction>(&earlier.message);
  if (!reply) return true;
  if (std::holds_alternative<record::CommandEffect>(later.message))
    return reply->reply_at <= same_instant(later.st);
  const auto* other = std::get_if<record::Interaction>(&later.message);
  if (!other) return true;
  // Its message may have arrived after the other one had been let go.
  if (other->received) return true;
  // On a shared board, a request comes before its instant is known.
  const bool was_held = !other->computed && (other->st_at_arrival < later.st ||
                                             other->wall_at_arrival < reply->wall_at_release);
  const bool was_awaited =
      other->request_at <= same_instant(later.st) && other->request_at < reply->reply_at;
  return !was_held && !was_awaited;
}

void RunLog::write(SimTime st, record::Message& message) {
  if (repeatable_) {
    if (auto* interaction = std::get_if<record::Interaction>(&message)) {
      interaction->wall_at_arrival = interaction->wall_at_release = {};
      interaction->previous_link_time.reset();
    }
  }
  guarded([&] { recorder_->write(st, message); });
}

}  // namespace tether::coordinator
