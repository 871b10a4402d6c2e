// The table of messages. A row has the id, the name, and the fields in the order of the payload:
// "name:type[count](unit)", where the type is a letter for its kind and its bits, and "|" is before
// the extensions. All else follows from it (message_type.cpp).

#include "table.h"

namespace tether::mavlink {
namespace {

constexpr Row kRows[] = {
    {0, "HEARTBEAT",
     "custom_mode:u32 type:u8 autopilot:u8 base_mode:u8 system_status:u8 mavlink_version:u8"},
    {1, "SYS_STATUS",
     "onboard_control_sensors_present:u32 onboard_control_sensors_enabled:u32 "
     "onboard_control_sensors_health:u32 load:u16(d%) voltage_battery:u16(mV) "
     "current_battery:i16(cA) drop_rate_comm:u16(c%) errors_comm:u16 errors_count1:u16 "
     "errors_count2:u16 errors_count3:u16 errors_count4:u16 battery_remaining:i8(%) | "
     "onboard_control_sensors_present_extended:u32 "
     "onboard_control_sensors_enabled_extended:u32 onboard_control_sensors_health_extended:u32"},
    {2, "SYSTEM_TIME", "time_unix_usec:u64(us) time_boot_ms:u32(ms)"},
    {4, "PING", "time_usec:u64(us) seq:u32 target_system:u8 target_component:u8"},
    {11, "SET_MODE", "custom_mode:u32 target_system:u8 base_mode:u8"},
    {20, "PARAM_REQUEST_READ",
     "param_index:i16 target_system:u8 target_component:u8 param_id:c[16]"},
    {21, "PARAM_REQUEST_LIST", "target_system:u8 target_component:u8"},
    {22, "PARAM_VALUE",
     "param_value:f param_count:u16 param_index:u16 param_id:c[16] param_type:u8"},
    {23, "PARAM_SET",
     "param_value:f target_system:u8 target_component:u8 param_id:c[16] param_type:u8"},
    {24, "GPS_RAW_INT",
     "time_usec:u64(us) lat:i32(degE7) lon:i32(degE7) alt:i32(mm) eph:u16 epv:u16 "
     "vel:u16(cm/s) cog:u16(cdeg) fix_type:u8 satellites_visible:u8 | alt_ellipsoid:i32(mm) "
     "h_acc:u32(mm) v_acc:u32(mm) vel_acc:u32(mm/s) hdg_acc:u32(degE5) yaw:u16(cdeg)"},
    {26, "SCALED_IMU",
     "time_boot_ms:u32(ms) xacc:i16(mG) yacc:i16(mG) zacc:i16(mG) xgyro:i16(mrad/s) "
     "ygyro:i16(mrad/s) zgyro:i16(mrad/s) xmag:i16(mgauss) ymag:i16(mgauss) zmag:i16(mgauss) | "
     "temperature:i16(cdegC)"},
    {27, "RAW_IMU",
     "time_usec:u64(us) xacc:i16 yacc:i16 zacc:i16 xgyro:i16 ygyro:i16 zgyro:i16 xmag:i16 "
     "ymag:i16 zmag:i16 | id:u8 temperature:i16(cdegC)"},
    {29, "SCALED_PRESSURE",
     "time_boot_ms:u32(ms) press_abs:f(hPa) press_diff:f(hPa) temperature:i16(cdegC) | "
     "temperature_press_diff:i16(cdegC)"},
    {30, "ATTITUDE",
     "time_boot_ms:u32(ms) roll:f(rad) pitch:f(rad) yaw:f(rad) rollspeed:f(rad/s) "
     "pitchspeed:f(rad/s) yawspeed:f(rad/s)"},
    {31, "ATTITUDE_QUATERNION",
     "time_boot_ms:u32(ms) q1:f q2:f q3:f q4:f rollspeed:f(rad/s) pitchspeed:f(rad/s) "
     "yawspeed:f(rad/s) | repr_offset_q:f[4]"},
    {32, "LOCAL_POSITION_NED",
     "time_boot_ms:u32(ms) x:f(m) y:f(m) z:f(m) vx:f(m/s) vy:f(m/s) vz:f(m/s)"},
    {33, "GLOBAL_POSITION_INT",
     "time_boot_ms:u32(ms) lat:i32(degE7) lon:i32(degE7) alt:i32(mm) relative_alt:i32(mm) "
     "vx:i16(cm/s) vy:i16(cm/s) vz:i16(cm/s) hdg:u16(cdeg)"},
    {36, "SERVO_OUTPUT_RAW",
     "time_usec:u32(us) servo1_raw:u16(us) servo2_raw:u16(us) servo3_raw:u16(us) "
     "servo4_raw:u16(us) servo5_raw:u16(us) servo6_raw:u16(us) servo7_raw:u16(us) "
     "servo8_raw:u16(us) port:u8 | servo9_raw:u16(us) servo10_raw:u16(us) servo11_raw:u16(us) "
     "servo12_raw:u16(us) servo13_raw:u16(us) servo14_raw:u16(us) servo15_raw:u16(us) "
     "servo16_raw:u16(us)"},
    {37, "MISSION_REQUEST_PARTIAL_LIST",
     "start_index:i16 end_index:i16 target_system:u8 target_component:u8 | mission_type:u8"},
    {39, "MISSION_ITEM",
     "param1:f param2:f param3:f param4:f x:f y:f z:f seq:u16 command:u16 target_system:u8 "
     "target_component:u8 frame:u8 current:u8 autocontinue:u8 | mission_type:u8"},
    {40, "MISSION_REQUEST", "seq:u16 target_system:u8 target_component:u8 | mission_type:u8"},
    {41, "MISSION_SET_CURRENT", "seq:u16 target_system:u8 target_component:u8"},
    {42, "MISSION_CURRENT",
     "seq:u16 | total:u16 mission_state:u8 mission_mode:u8 mission_id:u32 fence_id:u32 "
     "rally_points_id:u32"},
    {43, "MISSION_REQUEST_LIST", "target_system:u8 target_component:u8 | mission_type:u8"},
    {44, "MISSION_COUNT",
     "count:u16 target_system:u8 target_component:u8 | mission_type:u8 opaque_id:u32"},
    {45, "MISSION_CLEAR_ALL", "target_system:u8 target_component:u8 | mission_type:u8"},
    {46, "MISSION_ITEM_REACHED", "seq:u16"},
    {47, "MISSION_ACK",
     "target_system:u8 target_component:u8 type:u8 | mission_type:u8 opaque_id:u32"},
    {48, "SET_GPS_GLOBAL_ORIGIN",
     "latitude:i32(degE7) longitude:i32(degE7) altitude:i32(mm) target_system:u8 | "
     "time_usec:u64(us)"},
    {49, "GPS_GLOBAL_ORIGIN",
     "latitude:i32(degE7) longitude:i32(degE7) altitude:i32(mm) | time_usec:u64(us)"},
    {51, "MISSION_REQUEST_INT", "seq:u16 target_system:u8 target_component:u8 | mission_type:u8"},
    {65, "RC_CHANNELS",
     "time_boot_ms:u32(ms) chan1_raw:u16(us) chan2_raw:u16(us) chan3_raw:u16(us) "
     "chan4_raw:u16(us) chan5_raw:u16(us) chan6_raw:u16(us) chan7_raw:u16(us) "
     "chan8_raw:u16(us) chan9_raw:u16(us) chan10_raw:u16(us) chan11_raw:u16(us) "
     "chan12_raw:u16(us) chan13_raw:u16(us) chan14_raw:u16(us) chan15_raw:u16(us) "
     "chan16_raw:u16(us) chan17_raw:u16(us) chan18_raw:u16(us) chancount:u8 rssi:u8"},
    {66, "REQUEST_DATA_STREAM",
     "req_message_rate:u16(Hz) target_system:u8 target_component:u8 req_stream_id:u8 "
     "start_stop:u8"},
    {67, "DATA_STREAM", "message_rate:u16(Hz) stream_id:u8 on_off:u8"},
    {69, "MANUAL_CONTROL",
     "x:i16 y:i16 z:i16 r:i16 buttons:u16 target:u8 | buttons2:u16 enabled_extensions:u8 s:i16 "
     "t:i16 aux1:i16 aux2:i16 aux3:i16 aux4:i16 aux5:i16 aux6:i16"},
    {73, "MISSION_ITEM_INT",
     "param1:f param2:f param3:f param4:f x:i32 y:i32 z:f seq:u16 command:u16 target_system:u8 "
     "target_component:u8 frame:u8 current:u8 autocontinue:u8 | mission_type:u8"},
    {74, "VFR_HUD",
     "airspeed:f(m/s) groundspeed:f(m/s) alt:f(m) climb:f(m/s) heading:i16(deg) "
     "throttle:u16(%)"},
    {75, "COMMAND_INT",
     "param1:f param2:f param3:f param4:f x:i32 y:i32 z:f command:u16 target_system:u8 "
     "target_component:u8 frame:u8 current:u8 autocontinue:u8"},
    {76, "COMMAND_LONG",
     "param1:f param2:f param3:f param4:f param5:f param6:f param7:f command:u16 "
     "target_system:u8 target_component:u8 confirmation:u8"},
    {77, "COMMAND_ACK",
     "command:u16 result:u8 | progress:u8(%) result_param2:i32 target_system:u8 "
     "target_component:u8"},
    {82, "SET_ATTITUDE_TARGET",
     "time_boot_ms:u32(ms) q:f[4] body_roll_rate:f(rad/s) body_pitch_rate:f(rad/s) "
     "body_yaw_rate:f(rad/s) thrust:f target_system:u8 target_component:u8 type_mask:u8 | "
     "thrust_body:f[3]"},
    {83, "ATTITUDE_TARGET",
     "time_boot_ms:u32(ms) q:f[4] body_roll_rate:f(rad/s) body_pitch_rate:f(rad/s) "
     "body_yaw_rate:f(rad/s) thrust:f type_mask:u8"},
    {84, "SET_POSITION_TARGET_LOCAL_NED",
     "time_boot_ms:u32(ms) x:f(m) y:f(m) z:f(m) vx:f(m/s) vy:f(m/s) vz:f(m/s) afx:f(m/s/s) "
     "afy:f(m/s/s) afz:f(m/s/s) yaw:f(rad) yaw_rate:f(rad/s) type_mask:u16 target_system:u8 "
     "target_component:u8 coordinate_frame:u8"},
    {85, "POSITION_TARGET_LOCAL_NED",
     "time_boot_ms:u32(ms) x:f(m) y:f(m) z:f(m) vx:f(m/s) vy:f(m/s) vz:f(m/s) afx:f(m/s/s) "
     "afy:f(m/s/s) afz:f(m/s/s) yaw:f(rad) yaw_rate:f(rad/s) type_mask:u16 coordinate_frame:u8"},
    {86, "SET_POSITION_TARGET_GLOBAL_INT",
     "time_boot_ms:u32(ms) lat_int:i32(degE7) lon_int:i32(degE7) alt:f(m) vx:f(m/s) vy:f(m/s) "
     "vz:f(m/s) afx:f(m/s/s) afy:f(m/s/s) afz:f(m/s/s) yaw:f(rad) yaw_rate:f(rad/s) "
     "type_mask:u16 target_system:u8 target_component:u8 coordinate_frame:u8"},
    {87, "POSITION_TARGET_GLOBAL_INT",
     "time_boot_ms:u32(ms) lat_int:i32(degE7) lon_int:i32(degE7) alt:f(m) vx:f(m/s) vy:f(m/s) "
     "vz:f(m/s) afx:f(m/s/s) afy:f(m/s/s) afz:f(m/s/s) yaw:f(rad) yaw_rate:f(rad/s) "
     "type_mask:u16 coordinate_frame:u8"},
    {91, "HIL_CONTROLS",
     "time_usec:u64(us) roll_ailerons:f pitch_elevator:f yaw_rudder:f throttle:f aux1:f aux2:f "
     "aux3:f aux4:f mode:u8 nav_mode:u8"},
    {93, "HIL_ACTUATOR_CONTROLS", "time_usec:u64(us) flags:u64 controls:f[16] mode:u8"},
    {102, "VISION_POSITION_ESTIMATE",
     "usec:u64(us) x:f(m) y:f(m) z:f(m) roll:f(rad) pitch:f(rad) yaw:f(rad) | covariance:f[21] "
     "reset_counter:u8"},
    {103, "VISION_SPEED_ESTIMATE",
     "usec:u64(us) x:f(m/s) y:f(m/s) z:f(m/s) | covariance:f[9] reset_counter:u8"},
    {104, "VICON_POSITION_ESTIMATE",
     "usec:u64(us) x:f(m) y:f(m) z:f(m) roll:f(rad) pitch:f(rad) yaw:f(rad) | covariance:f[21]"},
    {105, "HIGHRES_IMU",
     "time_usec:u64(us) xacc:f(m/s/s) yacc:f(m/s/s) zacc:f(m/s/s) xgyro:f(rad/s) "
     "ygyro:f(rad/s) zgyro:f(rad/s) xmag:f(gauss) ymag:f(gauss) zmag:f(gauss) "
     "abs_pressure:f(hPa) diff_pressure:f(hPa) pressure_alt:f temperature:f(degC) "
     "fields_updated:u16 | id:u8"},
    {106, "OPTICAL_FLOW_RAD",
     "time_usec:u64(us) integration_time_us:u32(us) integrated_x:f(rad) integrated_y:f(rad) "
     "integrated_xgyro:f(rad) integrated_ygyro:f(rad) integrated_zgyro:f(rad) "
     "time_delta_distance_us:u32(us) distance:f(m) temperature:i16(cdegC) sensor_id:u8 "
     "quality:u8"},
    {107, "HIL_SENSOR",
     "time_usec:u64(us) xacc:f(m/s/s) yacc:f(m/s/s) zacc:f(m/s/s) xgyro:f(rad/s) "
     "ygyro:f(rad/s) zgyro:f(rad/s) xmag:f(gauss) ymag:f(gauss) zmag:f(gauss) "
     "abs_pressure:f(hPa) diff_pressure:f(hPa) pressure_alt:f temperature:f(degC) "
     "fields_updated:u32 | id:u8"},
    {111, "TIMESYNC", "tc1:i64(ns) ts1:i64(ns) | target_system:u8 target_component:u8"},
    {113, "HIL_GPS",
     "time_usec:u64(us) lat:i32(degE7) lon:i32(degE7) alt:i32(mm) eph:u16 epv:u16 "
     "vel:u16(cm/s) vn:i16(cm/s) ve:i16(cm/s) vd:i16(cm/s) cog:u16(cdeg) fix_type:u8 "
     "satellites_visible:u8 | id:u8 yaw:u16(cdeg)"},
    {114, "HIL_OPTICAL_FLOW",
     "time_usec:u64(us) integration_time_us:u32(us) integrated_x:f(rad) integrated_y:f(rad) "
     "integrated_xgyro:f(rad) integrated_ygyro:f(rad) integrated_zgyro:f(rad) "
     "time_delta_distance_us:u32(us) distance:f(m) temperature:i16(cdegC) sensor_id:u8 "
     "quality:u8"},
    {115, "HIL_STATE_QUATERNION",
     "time_usec:u64(us) attitude_quaternion:f[4] rollspeed:f(rad/s) pitchspeed:f(rad/s) "
     "yawspeed:f(rad/s) lat:i32(degE7) lon:i32(degE7) alt:i32(mm) vx:i16(cm/s) vy:i16(cm/s) "
     "vz:i16(cm/s) ind_airspeed:u16(cm/s) true_airspeed:u16(cm/s) xacc:i16(mG) yacc:i16(mG) "
     "zacc:i16(mG)"},
    {132, "DISTANCE_SENSOR",
     "time_boot_ms:u32(ms) min_distance:u16(cm) max_distance:u16(cm) current_distance:u16(cm) "
     "type:u8 id:u8 orientation:u8 covariance:u8(cm^2) | horizontal_fov:f(rad) "
     "vertical_fov:f(rad) quaternion:f[4] signal_quality:u8(%)"},
    {138, "ATT_POS_MOCAP", "time_usec:u64(us) q:f[4] x:f(m) y:f(m) z:f(m) | covariance:f[21]"},
    {141, "ALTITUDE",
     "time_usec:u64(us) altitude_monotonic:f(m) altitude_amsl:f(m) altitude_local:f(m) "
     "altitude_relative:f(m) altitude_terrain:f(m) bottom_clearance:f(m)"},
    {147, "BATTERY_STATUS",
     "current_consumed:i32(mAh) energy_consumed:i32(hJ) temperature:i16(cdegC) "
     "voltages:u16[10](mV) current_battery:i16(cA) id:u8 battery_function:u8 type:u8 "
     "battery_remaining:i8(%) | time_remaining:i32(s) charge_state:u8 voltages_ext:u16[4](mV) "
     "mode:u8 fault_bitmask:u32"},
    {148, "AUTOPILOT_VERSION",
     "capabilities:u64 uid:u64 flight_sw_version:u32 middleware_sw_version:u32 "
     "os_sw_version:u32 board_version:u32 vendor_id:u16 product_id:u16 "
     "flight_custom_version:u8[8] middleware_custom_version:u8[8] os_custom_version:u8[8] | "
     "uid2:u8[18]"},
    {149, "LANDING_TARGET",
     "time_usec:u64(us) angle_x:f(rad) angle_y:f(rad) distance:f(m) size_x:f(rad) "
     "size_y:f(rad) target_num:u8 frame:u8 | x:f(m) y:f(m) z:f(m) q:f[4] type:u8 "
     "position_valid:u8"},
    {193, "EKF_STATUS_REPORT",  // of ArduPilot
     "velocity_variance:f pos_horiz_variance:f pos_vert_variance:f compass_variance:f "
     "terrain_alt_variance:f flags:u16 | airspeed_variance:f"},
    {230, "ESTIMATOR_STATUS",
     "time_usec:u64(us) vel_ratio:f pos_horiz_ratio:f pos_vert_ratio:f mag_ratio:f "
     "hagl_ratio:f tas_ratio:f pos_horiz_accuracy:f(m) pos_vert_accuracy:f(m) flags:u16"},
    {231, "WIND_COV",
     "time_usec:u64(us) wind_x:f(m/s) wind_y:f(m/s) wind_z:f(m/s) var_horiz:f(m/s) "
     "var_vert:f(m/s) wind_alt:f(m) horiz_accuracy:f(m/s) vert_accuracy:f(m/s)"},
    {232, "GPS_INPUT",
     "time_usec:u64(us) time_week_ms:u32(ms) lat:i32(degE7) lon:i32(degE7) alt:f(m) hdop:f "
     "vdop:f vn:f(m/s) ve:f(m/s) vd:f(m/s) speed_accuracy:f(m/s) horiz_accuracy:f(m) "
     "vert_accuracy:f(m) ignore_flags:u16 time_week:u16 gps_id:u8 fix_type:u8 "
     "satellites_visible:u8 | yaw:u16(cdeg)"},
    {241, "VIBRATION",
     "time_usec:u64(us) vibration_x:f vibration_y:f vibration_z:f clipping_0:u32 "
     "clipping_1:u32 clipping_2:u32"},
    {242, "HOME_POSITION",
     "latitude:i32(degE7) longitude:i32(degE7) altitude:i32(mm) x:f(m) y:f(m) z:f(m) q:f[4] "
     "approach_x:f(m) approach_y:f(m) approach_z:f(m) | time_usec:u64(us)"},
    {243, "SET_HOME_POSITION",
     "latitude:i32(degE7) longitude:i32(degE7) altitude:i32(mm) x:f(m) y:f(m) z:f(m) q:f[4] "
     "approach_x:f(m) approach_y:f(m) approach_z:f(m) target_system:u8 | time_usec:u64(us)"},
    {244, "MESSAGE_INTERVAL", "interval_us:i32(us) message_id:u16"},
    {245, "EXTENDED_SYS_STATE", "vtol_state:u8 landed_state:u8"},
    {250, "DEBUG_VECT", "time_usec:u64(us) x:f y:f z:f name:c[10]"},
    {251, "NAMED_VALUE_FLOAT", "time_boot_ms:u32(ms) value:f name:c[10]"},
    {252, "NAMED_VALUE_INT", "time_boot_ms:u32(ms) value:i32 name:c[10]"},
    {253, "STATUSTEXT", "severity:u8 text:c[50] | id:u16 chunk_seq:u8"},
    {254, "DEBUG", "time_boot_ms:u32(ms) value:f ind:u8"},
    {291, "ESC_STATUS",
     "time_usec:u64(us) rpm:i32[4](rpm) voltage:f[4](V) current:f[4](A) index:u8"},
    {330, "OBSTACLE_DISTANCE",
     "time_usec:u64(us) distances:u16[72](cm) min_distance:u16(cm) max_distance:u16(cm) "
     "sensor_type:u8 increment:u8(deg) | increment_f:f(deg) angle_offset:f(deg) frame:u8"},
    {331, "ODOMETRY",
     "time_usec:u64(us) x:f(m) y:f(m) z:f(m) q:f[4] vx:f(m/s) vy:f(m/s) vz:f(m/s) "
     "rollspeed:f(rad/s) pitchspeed:f(rad/s) yawspeed:f(rad/s) pose_covariance:f[21] "
     "velocity_covariance:f[21] frame_id:u8 child_frame_id:u8 | reset_counter:u8 "
     "estimator_type:u8 quality:i8(%)"},
    {332, "TRAJECTORY_REPRESENTATION_WAYPOINTS",
     "time_usec:u64(us) pos_x:f[5](m) pos_y:f[5](m) pos_z:f[5](m) vel_x:f[5](m/s) "
     "vel_y:f[5](m/s) vel_z:f[5](m/s) acc_x:f[5](m/s/s) acc_y:f[5](m/s/s) acc_z:f[5](m/s/s) "
     "pos_yaw:f[5](rad) vel_yaw:f[5](rad/s) command:u16[5] valid_points:u8"},
    {375, "ACTUATOR_OUTPUT_STATUS", "time_usec:u64(us) active:u32 actuator:f[32]"},
    {385, "TUNNEL",
     "payload_type:u16 target_system:u8 target_component:u8 payload_length:u8 payload:u8[128]"},
};

}  // namespace

std::span<const Row> rows() {
  return kRows;
}

}  // namespace tether::mavlink
