#pragma once

#include <tether/sim/bytes.h>
#include <tether/sim/world.h>

/// The parts of a world, of a request for one and of the warnings about it, for tether/sim/bytes.h.
namespace tether::sim {

TETHER_PARTS(FileLocation, file, line)
TETHER_PARTS(Warning, consequence, where, subject, message, can_change_verdict)

TETHER_PARTS(MeshGeometry, file, submesh, scale, is_centered, named_at, companions, piece, made)
TETHER_PARTS(Material, diffuse, ambient, specular, emissive, alpha, albedo_map, repeat_x, repeat_y,
             albedo_map_at, repeat, is_double_sided, is_of_script)
TETHER_PARTS(Visual, name, X_LV, geometry, material, cast_shadows, has_look_of_mesh, joints)
TETHER_PARTS(Collision, name, X_LC, geometry, friction, intensity, bits)
TETHER_PARTS(Link, name, X_ML, mass, X_LI, inertia, visuals, collisions)
void each_part(auto& io, Is<DrivenPath> auto& path) {
  io(path.waypoints, path.repeats, path.delay, path.p_WO);
}
TETHER_PARTS(Model, name, X_WM, is_static, links, path)
TETHER_PARTS(Light, name, kind, X_WL, direction, diffuse, specular, constant, linear, quadratic,
             outer_angle, falloff, cast_shadows)

TETHER_PARTS(CameraModel, intrinsics, near, far, noise, exposure, readout, antialias, antialias_at,
             kind, depth_min, depth_max)
TETHER_PARTS(RangeModel, least, most, resolution, noise, rays, dropout)
TETHER_PARTS(BarometerModel, noise, reference_altitude)
TETHER_PARTS(uav::DriverModel, offset, jitter, drift, lost, repeated)
TETHER_PARTS(Sensor, name, X_BS, update_rate, model, declared_at, driver, joints)
TETHER_PARTS(uav::Rotor, p_BR, direction)
TETHER_PARTS(uav::MultirotorParameters, mass, inertia, rotors, thrust, moment, drag, linear_drag,
             max_speed, time_up, time_down, max_tilt, max_horizontal, max_vertical, max_yaw_rate,
             max_acceleration, max_yaw_acceleration)
TETHER_PARTS(uav::Joint, name, p_BJ, axis_B, least, most, rate)
TETHER_PARTS(energy::Battery, capacity, voltage_at_charge, resistance, cut_off, initial_charge)
TETHER_PARTS(energy::Model, propulsion, battery, computer, sensors)
TETHER_PARTS(Uav, name, X_WB, body, airframe, sensors, battery, energy, payloads, joints,
             airframe_from, by_default)

TETHER_PARTS(uav::Anchor, name, shape, size, colour)
TETHER_PARTS(PlacedAnchor, anchor, X_WA)
TETHER_PARTS(World, name, file, gravity, gravity_x, gravity_y, step, step_from, step_at, place,
             magnetic_field, wind, ambient, background, models, lights, uavs, anchors, files,
             sdf_files, is_strict)

TETHER_PARTS(UavPlacement, name, model, p_WB, yaw)
TETHER_PARTS(WorldOptions, model_folders, is_strict, is_tolerant)
TETHER_PARTS(WorldRequest, world, uavs, anchors, anchors_at, options)

}  // namespace tether::sim
