#include "run_log.h"

#include <limits>

#include <tether/record/png.h>

namespace tether::coordinator {

void RunLog::interaction(SimTime st, const record::Interaction& entry) {
  ++footer_.interactions;
  if (entry.violation) ++footer_.causality_violations;
  footer_.largest_lag = std::max(footer_.largest_lag, entry.lag);
  footer_.largest_grid_error = std::max(footer_.largest_grid_error, entry.grid_error);
  recorder_->write(st, entry);
}

void RunLog::command_effect(SimTime st, const std::string& uav, const PendingCommand& command) {
  const auto& [velocity, yaw_rate] = command.command;
  recorder_->write(st, record::CommandEffect{.uav = uav,
                                             .sequence = command.sequence,
                                             .applied_at = st,
                                             .vx_H_m_s = velocity.x,
                                             .vy_H_m_s = velocity.y,
                                             .vz_H_m_s = velocity.z,
                                             .yaw_rate_rad_s = yaw_rate});
}

void RunLog::ground_truth(const std::string& uav, const sim::GroundTruth& truth) {
  const auto& [p, q, v, w] = truth.body;
  recorder_->write(truth.at, record::GroundTruth{.uav = uav,
                                                 .at = truth.at,
                                                 .p_WB_m = {p.x, p.y, p.z},
                                                 .q_WB = {q.w, q.x, q.y, q.z},
                                                 .v_WB_m_s = {v.x, v.y, v.z},
                                                 .w_WB_B_rad_s = {w.x, w.y, w.z}});
}

void RunLog::contact(SimTime st, const std::string& uav, const sim::Contact& contact) {
  recorder_->write(
      st, record::Contact{
              .uav = uav, .at = contact.at, .with = contact.with, .speed_m_s = contact.speed_m_s});
}

void RunLog::clearance(SimTime st, const std::string& uav, const sim::Clearance& clearance) {
  auto& least = footer_.clearances;
  auto own = std::ranges::find(least, uav, &record::Clearance::uav);
  if (own == least.end()) {
    own = least.insert(own, {uav, std::numeric_limits<double>::infinity(), {}, {}});
  }
  if (clearance.distance_m >= own->min_m) return;
  *own = {uav, clearance.distance_m, st, std::string(clearance.to)};
}

void RunLog::stop(SimTime st, const record::Stop& stop) {
  ++footer_.stops;
  if (stop.reply_at)
    footer_.largest_overshoot = std::max(footer_.largest_overshoot, stop.at - *stop.reply_at);
  recorder_->write(st, stop);
}

void RunLog::image(SimTime st, const std::string& uav, const std::string& sensor,
                   const uav::CameraSample& sample) {
  recorder_->write(
      st, record::Image{.uav = uav,
                        .sensor = sensor,
                        .at = sample.sampled_at,
                        .index = sample.index,
                        .png = record::encode_png(sample.width_px, sample.height_px, sample.rgb)});
}

}  // namespace tether::coordinator
