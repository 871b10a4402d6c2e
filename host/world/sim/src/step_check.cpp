#include "eigenvalues.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <tether/sim/simulator.h>

namespace tether::sim {
namespace {

using uav::Vec3;

/// So many of the numbers below are no speeds of rotors.
constexpr std::size_t kOfBody = 15;

struct Flight {
  uav::BodyState body;
  uav::MultirotorState state;
};

/// The numbers that a disturbance of hover changes. The position has no part in the loop; the
/// set-points are those of the command.
std::vector<double*> numbers_of(Flight& flight, Vec3& tilt, std::size_t rotors) {
  std::vector<double*> numbers;  // the rotors' last
  for (Vec3* v : {&flight.body.v_WB, &tilt, &flight.body.w_WB_B, &flight.state.velocity_integral_W,
                  &flight.state.rate_integral_B})
    for (double* number : {&v->x, &v->y, &v->z}) numbers.push_back(number);
  for (std::size_t i = 0; i < rotors; ++i) numbers.push_back(&flight.state.rotor_speed_rad_s[i]);
  return numbers;
}

uav::Quat turned(const Vec3& by) {
  const double angle = norm(by);
  if (angle == 0.0) return {};
  const Vec3 v = (std::sin(0.5 * angle) / angle) * by;
  return {std::cos(0.5 * angle), v.x, v.y, v.z};
}

/// Hover for one step, with one number changed before it.
class HoverStep {
 public:
  HoverStep(const uav::MultirotorParameters& airframe, double gravity_m_s2, Duration step)
      : multirotor_(airframe, gravity_m_s2, step),
        gravity_m_s2_(gravity_m_s2),
        dt_s_(to_seconds(step)),
        hover_{{}, uav::hover_state(airframe, gravity_m_s2, 0.0)} {}

  std::size_t size() const { return kOfBody + multirotor_.parameters().rotors.size(); }

  /// What the numbers are after it.
  std::vector<double> after(std::size_t changed, double by) const {
    Flight flight = hover_;
    Vec3 tilt;
    const auto numbers = numbers_of(flight, tilt, multirotor_.parameters().rotors.size());
    *numbers[changed] += by;
    flight.body.q_WB = turned(tilt);
    advance(flight);
    const uav::Quat& q = flight.body.q_WB;
    tilt = 2.0 * Vec3{q.x, q.y, q.z};  // for small angles
    std::vector<double> values;
    for (const double* number : numbers) values.push_back(*number);
    return values;
  }

 private:
  /// As the simulators do: velocities first, then with them the pose.
  void advance(Flight& flight) const {
    const uav::MultirotorParameters& frame = multirotor_.parameters();
    uav::BodyState& body = flight.body;
    const uav::Wrench wrench = multirotor_.step(body, {}, flight.state);
    body.v_WB = body.v_WB + (dt_s_ / frame.mass_kg) * rotate(body.q_WB, wrench.force_B) -
                Vec3{0, 0, dt_s_ * gravity_m_s2_};
    const Vec3& inertia = frame.inertia_kg_m2;
    const Vec3& torque = wrench.torque_B;
    body.w_WB_B = body.w_WB_B +
                  dt_s_ * Vec3{torque.x / inertia.x, torque.y / inertia.y, torque.z / inertia.z};
    body.q_WB = body.q_WB * turned(dt_s_ * body.w_WB_B);
  }

  uav::Multirotor multirotor_;
  double gravity_m_s2_, dt_s_;
  Flight hover_;
};

Matrix derivative(const HoverStep& step) {
  Matrix derivative(step.size(), std::vector<std::complex<double>>(step.size()));
  for (std::size_t k = 0; k < step.size(); ++k) {
    const double change = k < kOfBody ? 1e-5 : 1e-3;
    const std::vector<double> above = step.after(k, change), below = step.after(k, -change);
    for (std::size_t i = 0; i < step.size(); ++i)
      derivative[i][k] = (above[i] - below[i]) / (2.0 * change);
  }
  return derivative;
}

/// The longest whole number of a tenth of a millisecond for which `holds`; 0 if there is none.
/// @pre `holds` for shorter steps if for longer ones
template <class Holds>
double longest_ms(Holds holds) {
  int good = 0;
  for (int bad = 1000; bad - good > 1;) {
    const int middle = (good + bad) / 2;
    (holds(middle * std::chrono::microseconds(100)) ? good : bad) = middle;
  }
  return 0.1 * good;
}

double lift_by_weight(const uav::MultirotorParameters& airframe, double gravity_m_s2) {
  return flight_limits(airframe).max_thrust_N / (airframe.mass_kg * gravity_m_s2);
}

}  // namespace

std::string set_at(const World& world) {
  if (world.step_at.file.empty()) return "";
  const int line = world.step_at.line;
  return fmt::format(" (set {} {}{})", line > 0 ? "at" : "for", world.step_at.file,
                     line > 0 ? fmt::format(":{}", line) : "");
}

HoverLoop hover_loop(const uav::MultirotorParameters& airframe, double gravity_m_s2,
                     Duration any_step) {
  // Below this, the loop is that of a controller without steps, and rounding would be seen.
  const Duration step = std::max<Duration>(any_step, std::chrono::microseconds(100));
  HoverLoop loop;
  // Rotors take longer to slow down than to speed up. Near hover they do both; the loop has to work
  // with either.
  for (const double constant_s : {airframe.time_constant_up_s, airframe.time_constant_down_s}) {
    uav::MultirotorParameters frame = airframe;
    frame.time_constant_up_s = frame.time_constant_down_s = constant_s;
    for (const auto& pole : eigenvalues(derivative(HoverStep(frame, gravity_m_s2, step)))) {
      const double growth = std::abs(pole);
      loop.growth = std::max(loop.growth, growth);
      if (pole.imag() == 0.0 && pole.real() >= 0.0) continue;
      const double decay = -std::log(std::max(growth, 1e-300));
      loop.damping = std::min(loop.damping, decay / std::hypot(decay, std::arg(pole)));
    }
  }
  return loop;
}

void check_step(const World& world, Controller controller, const WarningSink& warn) {
  constexpr double kEarth_m_s2 = 9.81, kRacing = 20.0;  // the strongest racers lift 15 times theirs
  for (const Uav& uav : world.uavs) {
    const std::string subject = fmt::format("UAV '{}'", uav.name);
    if (const double lift = lift_by_weight(uav.airframe, kEarth_m_s2); warn && lift > kRacing)
      warn({Consequence::kDoubtful,
            {},
            subject,
            fmt::format("lifts {:.3g} times its weight with all rotors at full speed: check the "
                        "units of its mass and thrust coefficient",
                        lift)});
    const auto loop_at = [&](Duration step) {
      return hover_loop(uav.airframe, world.gravity_m_s2, step);
    };
    const auto is_good = [&](Duration step) {
      const HoverLoop loop = loop_at(step);
      return loop.growth < 1.0 && loop.damping >= kLeastDamping;
    };
    if (is_good(world.step)) continue;
    const HoverLoop loop = loop_at(world.step);
    const bool is_stable = loop.growth < 1.0;
    const double most_ms = longest_ms(is_good);
    const std::string problem =
        fmt::format("{} by {} with a step of {} ms (damping ratio {:.2g})",
                    is_stable ? "is poorly damped" : "is not stabilised",
                    controller == Controller::kOurs ? "its controller" : "Tether's controller",
                    1e3 * to_seconds(world.step), loop.damping);
    const std::string advice =
        most_ms > 0.0 ? fmt::format("use a step of at most {:.1f} ms", most_ms)
                      : fmt::format(
                            "no step helps: its rotors are too slow (<time_constant_up_s>, "
                            "<time_constant_down_s>) or too weak (at full speed, they lift {:.2g} "
                            "times its weight)",
                            lift_by_weight(uav.airframe, world.gravity_m_s2));
    if (!is_stable && controller == Controller::kOurs)
      throw Error(ErrorCode::kBadFile,
                  world.step_at.file.empty() ? FileLocation{world.file.string(), 0} : world.step_at,
                  fmt::format("{} {}; {}", subject, problem, advice))
          .about(subject);
    if (warn)
      warn({Consequence::kBehavesDifferent, world.step_at, subject, problem + "; " + advice});
  }
}

}  // namespace tether::sim
