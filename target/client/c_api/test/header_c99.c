/* The C API as a C99 compiler sees it, and the layout that programs were compiled with: nothing here may change while
   TETHER_CLIENT_ABI_VERSION stays. Structs may grow at their end, so their sizes are at least these. */
#include <tether/client.h>

#define HOLDS(name, condition) typedef char holds_##name[(condition) ? 1 : -1]
#define LIES_AT(type, member, offset) HOLDS(type##_##member, offsetof(type, member) == (offset))

HOLDS(abi_version, TETHER_CLIENT_ABI_VERSION == 1);

HOLDS(vec3, sizeof(tether_vec3) == 24);
HOLDS(quat, sizeof(tether_quat) == 32);
HOLDS(pose, sizeof(tether_pose) == 56);
LIES_AT(tether_vec3, x, 0);
LIES_AT(tether_vec3, z, 16);
LIES_AT(tether_quat, w, 0);
LIES_AT(tether_quat, z, 24);
LIES_AT(tether_pose, position_m, 0);
LIES_AT(tether_pose, attitude, 24);

HOLDS(camera_model, sizeof(tether_camera_model) >= 80);
LIES_AT(tether_camera_model, width_px, 0);
LIES_AT(tether_camera_model, height_px, 4);
LIES_AT(tether_camera_model, fx_px, 8);
LIES_AT(tether_camera_model, fy_px, 16);
LIES_AT(tether_camera_model, cx_px, 24);
LIES_AT(tether_camera_model, cy_px, 32);
LIES_AT(tether_camera_model, k1, 40);
LIES_AT(tether_camera_model, k2, 48);
LIES_AT(tether_camera_model, p1, 56);
LIES_AT(tether_camera_model, p2, 64);
LIES_AT(tether_camera_model, k3, 72);

HOLDS(image_info, sizeof(tether_image_info) >= 32);
LIES_AT(tether_image_info, sampled_at_ns, 0);
LIES_AT(tether_image_info, index, 8);
LIES_AT(tether_image_info, width_px, 16);
LIES_AT(tether_image_info, height_px, 20);
LIES_AT(tether_image_info, size_bytes, 24);

HOLDS(imu_sample, sizeof(tether_imu_sample) >= 96);
LIES_AT(tether_imu_sample, sampled_at_ns, 0);
LIES_AT(tether_imu_sample, index, 8);
LIES_AT(tether_imu_sample, angular_velocity_rad_s, 16);
LIES_AT(tether_imu_sample, specific_force_m_s2, 40);
LIES_AT(tether_imu_sample, q_WS, 64);

HOLDS(range_sample, sizeof(tether_range_sample) >= 24);
LIES_AT(tether_range_sample, sampled_at_ns, 0);
LIES_AT(tether_range_sample, index, 8);
LIES_AT(tether_range_sample, range_m, 16);

HOLDS(navsat_sample, sizeof(tether_navsat_sample) >= 96);
LIES_AT(tether_navsat_sample, has_fix, 16);
LIES_AT(tether_navsat_sample, latitude_deg, 24);
LIES_AT(tether_navsat_sample, velocity_ENU_m_s, 48);
LIES_AT(tether_navsat_sample, speed_accuracy_m_s, 88);

HOLDS(magnetometer_sample, sizeof(tether_magnetometer_sample) >= 40);
LIES_AT(tether_magnetometer_sample, field_T, 16);

HOLDS(barometer_sample, sizeof(tether_barometer_sample) >= 32);
LIES_AT(tether_barometer_sample, pressure_Pa, 16);
LIES_AT(tether_barometer_sample, altitude_m, 24);

HOLDS(odometry_sample, sizeof(tether_odometry_sample) >= 192);
LIES_AT(tether_odometry_sample, p_WS, 16);
LIES_AT(tether_odometry_sample, q_WS, 40);
LIES_AT(tether_odometry_sample, v_WS_m_s, 72);
LIES_AT(tether_odometry_sample, w_WS_rad_s, 96);
LIES_AT(tether_odometry_sample, position_stddev_m, 120);
LIES_AT(tether_odometry_sample, attitude_stddev_rad, 144);
LIES_AT(tether_odometry_sample, velocity_stddev_m_s, 168);

HOLDS(joint_state_sample, sizeof(tether_joint_state_sample) >= 56);
LIES_AT(tether_joint_state_sample, joints, 16);
LIES_AT(tether_joint_state_sample, angles_rad, 24);

HOLDS(battery_sample, sizeof(tether_battery_sample) >= 40);
LIES_AT(tether_battery_sample, sampled_at_ns, 0);
LIES_AT(tether_battery_sample, voltage_v, 8);
LIES_AT(tether_battery_sample, current_a, 16);
LIES_AT(tether_battery_sample, charge, 24);
LIES_AT(tether_battery_sample, capacity_c, 32);

HOLDS(setpoint, sizeof(tether_setpoint) >= 240);
LIES_AT(tether_setpoint, after_ns, 0);
LIES_AT(tether_setpoint, mask, 8);
LIES_AT(tether_setpoint, in_heading, 12);
LIES_AT(tether_setpoint, position_W_m, 16);
LIES_AT(tether_setpoint, velocity_m_s, 40);
LIES_AT(tether_setpoint, acceleration_m_s2, 64);
LIES_AT(tether_setpoint, yaw_rad, 88);
LIES_AT(tether_setpoint, yaw_rate_rad_s, 96);
LIES_AT(tether_setpoint, q_WB, 104);
LIES_AT(tether_setpoint, rates_B_rad_s, 136);
LIES_AT(tether_setpoint, thrust_N, 160);
LIES_AT(tether_setpoint, rotor_speeds_rad_s, 168);
LIES_AT(tether_setpoint, rotors, 232);

HOLDS(flight_limits, sizeof(tether_flight_limits) >= 24);
LIES_AT(tether_flight_limits, max_rotor_speed_rad_s, 0);
LIES_AT(tether_flight_limits, max_thrust_N, 8);
LIES_AT(tether_flight_limits, rotors, 16);

HOLDS(status, sizeof(tether_status) == 4);
HOLDS(statuses, TETHER_OK == 0 && TETHER_INVALID == 1 && TETHER_NOTHING_YET == 2 && TETHER_REFUSED == 3 &&
                    TETHER_DISCONNECTED == 4 && TETHER_PROTOCOL == 5 && TETHER_TIMEOUT == 6 &&
                    TETHER_RUN_ENDED == 7 && TETHER_NO_MEMORY == 8 && TETHER_INTERNAL == 9);
HOLDS(sensor_kinds, TETHER_CAMERA == 0 && TETHER_IMU == 1 && TETHER_RANGE == 2);
HOLDS(anchor_shapes, TETHER_BOX == 0 && TETHER_CYLINDER == 1 && TETHER_SPHERE == 2);
HOLDS(read_modes, TETHER_READ_NEXT == 0 && TETHER_READ_LATEST == 1 && TETHER_READ_IF_AVAILABLE == 2);
