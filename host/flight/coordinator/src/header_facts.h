#pragma once

#include <tether/energy/meter.h>
#include <tether/radio/settings.h>
#include <tether/record/messages.h>
#include <tether/sim/world.h>
#include <tether/uav/setpoint.h>

/// What the header says of models, so that the audit can compare it with the messages.
namespace tether::coordinator {

record::RadioInfo describe(const radio::Settings& radio);
record::Setpoint record_of(const uav::Setpoint& setpoint);
/// None: the energy of the UAV is not simulated.
std::optional<record::EnergyInfo> describe_energy(const sim::Uav& uav, double gravity_m_s2);
/// How far the collision shapes of a body reach from its origin; 0: it has none, or a mesh, whose
/// vertices only a simulator knows.
double extent_m(const sim::Link& body);
/// Whether only UAVs can move.
bool only_uavs_move(const sim::World& world);

}  // namespace tether::coordinator
