// Errors are those of Noise: white noise, a constant bias of the run, and a Gauss-Markov walk,
// which is the drift of a position (correlated over minutes) and, with a long correlation time, the
// random walk of an odometry. The accuracies that a sample reports are the standard deviations of
// these errors at its instant.

#include "sensors/navigation.h"

#include <cmath>

#include <tether/sim/geodesy.h>

namespace tether::sim {
namespace {

using uav::Vec3;

using Channels = std::array<std::string_view, 3>;

/// Noise along x and y, and along z.
Vec3 noise_of(const Noise& across, const Noise& up, const MeasurementKey& key,
              const Channels& channels) {
  return noise_of(std::array{across, across, up}, key, channels);
}

Vec3 stddev_of(const Noise& across, const Noise& up, SimTime at) {
  const double across_stddev = noise_stddev(across, at);
  return {across_stddev, across_stddev, noise_stddev(up, at)};
}

/// A turn by `v`'s length about `v`.
uav::Quat turn(const Vec3& v) {
  const double angle_rad = uav::norm(v);
  return angle_rad > 0.0 ? uav::from_axis_angle((1.0 / angle_rad) * v, angle_rad) : uav::Quat{};
}

}  // namespace

TrueMotion motion_of_sensor(const uav::Pose& X_WB, const BodyMotion& motion,
                            const uav::Pose& X_BS) {
  return {X_WB * X_BS, motion.v_WB_W + rotate(X_WB.q, cross(motion.w_WB_B, X_BS.p)),
          rotate(inverse(X_BS.q), motion.w_WB_B)};
}

// Each stretch of `outage_every_s` has one outage, which ends within it.
bool is_out(const NavSatModel& model, const MeasurementKey& key) {
  if (model.outage_lasts_s <= 0.0) return false;
  const double at_s = to_seconds(key.at);
  const double stretch = std::floor(at_s / model.outage_every_s);
  const std::uint64_t stream = random_stream(key.uav, key.sensor, "outage");
  const double begins_s =
      KeyedRandom({key.seed, stream, static_cast<std::uint64_t>(stretch)}).uniform() *
      (model.outage_every_s - model.outage_lasts_s);
  const double since_s = at_s - stretch * model.outage_every_s - begins_s;
  return since_s >= 0.0 && since_s < model.outage_lasts_s;
}

uav::NavSatSample measure_navsat(const NavSatModel& model, const TrueMotion& truth,
                                 const Place& place, const MeasurementKey& key) {
  uav::NavSatSample sample;
  sample.sampled_at = key.at;
  sample.index = key.index;
  if (is_out(model, key)) return sample;
  const Vec3 p_W = truth.X_WS.p + noise_of(model.horizontal_m, model.vertical_m, key,
                                           {"position_x", "position_y", "position_z"});
  const Vec3 v_W =
      truth.v_WS_W + noise_of(model.horizontal_velocity_m_s, model.vertical_velocity_m_s, key,
                              {"velocity_x", "velocity_y", "velocity_z"});
  const Geodetic geodetic = geodetic_of(place, p_W);
  sample.has_fix = true;
  sample.latitude_deg = geodetic.latitude_deg;
  sample.longitude_deg = geodetic.longitude_deg;
  sample.altitude_m = geodetic.altitude_m;
  sample.velocity_ENU_m_s = to_enu(place, v_W);
  sample.horizontal_accuracy_m = noise_stddev(model.horizontal_m, key.at);
  sample.vertical_accuracy_m = noise_stddev(model.vertical_m, key.at);
  sample.speed_accuracy_m_s = noise_stddev(model.horizontal_velocity_m_s, key.at);
  return sample;
}

uav::MagnetometerSample measure_magnetometer(const MagnetometerModel& model,
                                             const TrueMotion& truth, const Vec3& field_W_T,
                                             const MeasurementKey& key) {
  return {key.at, key.index,
          rotate(inverse(truth.X_WS.q), field_W_T) + model.hard_iron_T +
              noise_of(model.field_T, key, {"field_x", "field_y", "field_z"})};
}

uav::BarometerSample measure_barometer(const BarometerModel& model, const TrueMotion& truth,
                                       const Place& place, const MeasurementKey& key) {
  const double origin_m = model.reference_altitude_m.value_or(place.elevation_m);
  const double pressure_Pa = standard_pressure_pa(origin_m + truth.X_WS.p.z) +
                             noise_of(model.pressure_Pa, key, "pressure");
  return {key.at, key.index, pressure_Pa, standard_altitude_m(pressure_Pa)};
}

uav::OdometrySample measure_odometry(const OdometryModel& model, const TrueMotion& truth,
                                     const MeasurementKey& key) {
  const Noise& position = model.position_m;
  const Noise& velocity = model.velocity_m_s;
  const Vec3 turned_rad =
      noise_of(model.tilt_rad, model.yaw_rad, key, {"attitude_x", "attitude_y", "attitude_z"});
  uav::OdometrySample sample;
  sample.sampled_at = key.at;
  sample.index = key.index;
  sample.p_WS =
      truth.X_WS.p + noise_of(position, position, key, {"position_x", "position_y", "position_z"});
  sample.q_WS = turn(turned_rad) * truth.X_WS.q;
  sample.v_WS_m_s =
      truth.v_WS_W + noise_of(velocity, velocity, key, {"velocity_x", "velocity_y", "velocity_z"});
  sample.w_WS_rad_s =
      truth.w_WS_S + noise_of(model.angular_velocity_rad_s, model.angular_velocity_rad_s, key,
                              {"rate_x", "rate_y", "rate_z"});
  sample.position_stddev_m = stddev_of(position, position, key.at);
  sample.attitude_stddev_rad = stddev_of(model.tilt_rad, model.yaw_rad, key.at);
  sample.velocity_stddev_m_s = stddev_of(velocity, velocity, key.at);
  return sample;
}

}  // namespace tether::sim
