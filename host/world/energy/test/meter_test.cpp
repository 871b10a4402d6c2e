#include "known_energy.h"
#include "test_model.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/energy/meter.h>

namespace tether::energy {
namespace {

using namespace std::chrono_literals;

double of(const Status& status, Cause cause) {
  return status.spent_J[static_cast<std::size_t>(cause)];
}

/// Hovers from ST 0 on.
void hover(Meter& meter, Duration time) {
  const uav::MultirotorState rotors = uav::hover_state(kAirframe, kGravity_m_s2, 0.0);
  for (SimTime st; st < SimTime(time); st += 1ms) meter.step(st, 1ms, {}, rotors);
}

TEST(Meter, ChargesEachCauseForItsPower) {
  const Model model = hummingbird_model();
  Meter meter(model, kAirframe, kGravity_m_s2);
  meter.computing(2.0);
  hover(meter, 150ms);
  meter.computing(0.5);
  hover(meter, 200ms);
  meter.computing(0.0);
  hover(meter, 650ms);
  const Status& status = meter.status();
  EXPECT_NEAR(of(status, Cause::kLift),
              level_flight_power_W(kAirframe, model.propulsion, kGravity_m_s2, 0.0), 1e-6);
  EXPECT_NEAR(of(status, Cause::kMoving), 0.0, 1e-6);
  EXPECT_NEAR(of(status, Cause::kIdle), 2.3, 1e-9);
  EXPECT_NEAR(of(status, Cause::kComputing), 0.4, 1e-9);
  EXPECT_NEAR(of(status, Cause::kSensors), 1.5, 1e-9);
}

TEST(Meter, LimitsTheRotorsAsTheVoltageFalls) {
  Model model = hummingbird_model();
  model.battery.initial_charge = 0.05;
  Meter meter(model, kAirframe, kGravity_m_s2);
  hover(meter, 1s);
  EXPECT_NEAR(meter.speed_limit(), meter.status().voltage_V / 11.1, 1e-12);
  EXPECT_LT(meter.speed_limit(), 1.0);
}

TEST(Meter, StopsTheRotorsWhenTheBatteryIsEmpty) {
  Model model = hummingbird_model();
  model.battery.initial_charge = 0.001;
  Meter meter(model, kAirframe, kGravity_m_s2);
  hover(meter, 2s);
  ASSERT_TRUE(meter.status().empty_at.has_value());
  EXPECT_EQ(meter.speed_limit(), 0.0);
  const Status at_end = meter.status();
  hover(meter, 1s);
  EXPECT_EQ(meter.status(), at_end);
}

/// A flight of random commands, drawn by key, down to an empty battery if it is small.
struct Flight {
  Model model = hummingbird_model();
  Status end;

  explicit Flight(std::uint64_t key) {
    KeyedRandom random({key, 0, 0});
    model.battery.initial_charge = 0.005 + 0.995 * random.uniform();
    model.battery.resistance_ohm = 0.2 * random.uniform();
    model.propulsion.efficiency = 0.4 + 0.6 * random.uniform();
    Meter meter(model, kAirframe, kGravity_m_s2);
    uav::MultirotorState rotors = uav::hover_state(kAirframe, kGravity_m_s2, 0.0);
    uav::BodyState body;
    for (SimTime st; st < SimTime(20s); st += 1ms) {
      if (to_ns(st) % 100'000'000 == 0) {
        const auto any = [&](double most) { return most * (2.0 * random.uniform() - 1.0); };
        body.v_WB = {any(8.0), any(8.0), any(4.0)};
        body.w_WB_B = {any(3.0), any(3.0), any(3.0)};
        for (double& speed : rotors.rotor_speed_rad_s) speed = 400.0 + any(400.0);
        meter.computing(2.0 * random.uniform());
      }
      meter.step(st, 1ms, body, rotors);
    }
    end = meter.status();
  }
};

TEST(MeterProperty, CausesAddUpToWhatTheBatteryLost) {
  int emptied = 0;
  for (std::uint64_t key = 0; key < 40; ++key) {
    const Flight flight(key);
    const double lost_J =
        stored_energy_J(flight.model.battery, flight.model.battery.initial_charge) -
        stored_energy_J(flight.model.battery, flight.end.charge);
    const double spent_J =
        std::accumulate(flight.end.spent_J.begin(), flight.end.spent_J.end(), 0.0);
    EXPECT_NEAR(spent_J, lost_J, 1e-3 * lost_J) << key;
    emptied += flight.end.empty_at ? 1 : 0;
  }
  EXPECT_GT(emptied, 0);
  EXPECT_LT(emptied, 40);
}

}  // namespace
}  // namespace tether::energy
