#pragma once

#include <tether/client.h>

/// @cond
#ifdef __cplusplus
extern "C" {
#endif
/// @endcond

/// @defgroup c_commands Set-points
/// @ingroup c_api
/// Commands of every level of the flight controller. The world frame W is ENU, the body frame B is
/// FLU.
/// @{

/// Fields of a set-point; a mask is a sum of them. It is one of: position, also with velocity, or
/// with velocity and acceleration, which are fed forward; velocity, also with acceleration;
/// acceleration; attitude and thrust; body rates and thrust; rotor speeds. The first three can have
/// a yaw or a yaw rate, too; without, the UAV keeps its yaw. Each can have joints, which keep their
/// angles without; joints alone change nothing of the flight, and are a command of their own.
typedef enum tether_setpoint_field {
  TETHER_POSITION = 1,        ///< in W
  TETHER_VELOCITY = 2,        ///< in W or H
  TETHER_ACCELERATION = 4,    ///< in W or H
  TETHER_YAW = 8,             ///< not with a yaw rate
  TETHER_YAW_RATE = 16,       ///< not with a yaw
  TETHER_ATTITUDE = 32,       ///< with a thrust
  TETHER_BODY_RATES = 64,     ///< with a thrust
  TETHER_THRUST = 128,        ///< with an attitude or body rates
  TETHER_ROTOR_SPEEDS = 256,  ///< of all rotors
  TETHER_JOINTS = 512         ///< of all joints
} tether_setpoint_field;

/// A set-point. Fields that are not in the mask are ignored. Set all to 0 first: may grow.
typedef struct tether_setpoint {
  int64_t after_ns;               ///< from when the command takes effect [ns]
  uint32_t mask;                  ///< sum of tether_setpoint_field
  uint32_t in_heading;            ///< not 0: velocity and acceleration are in H; 0: in W
  tether_vec3 position_W_m;       ///< p_WB
  tether_vec3 velocity_m_s;       ///< of the body
  tether_vec3 acceleration_m_s2;  ///< of the motion: 0 when hovering
  double yaw_rad;                 ///< counter-clockwise from east
  double yaw_rate_rad_s;          ///< counter-clockwise seen from above
  tether_quat q_WB;               ///< attitude, of unit length to 1e-6
  tether_vec3 rates_B_rad_s;      ///< w_WB in B
  double thrust_N;                ///< of all rotors together, along the body's z
  double rotor_speeds_rad_s[8];   ///< of the first `rotors`, in the order of the UAV's model
  uint32_t rotors;                ///< how many rotor speeds there are
  uint32_t joints;                ///< how many angles of joints there are
  double joints_rad[4];           ///< of all `joints`, as tether_get_joint() numbers them
} tether_setpoint;

/// The most that the UAV can be commanded. May grow.
typedef struct tether_flight_limits {
  double max_rotor_speed_rad_s;  ///< of each rotor
  double max_thrust_N;           ///< of all rotors together
  uint32_t rotors;    ///< 0: it only takes velocities in the heading frame, without a yaw
  uint32_t reserved;  ///< 0
} tether_flight_limits;

/// Reads what the UAV can be commanded. Never blocks.
/// @param vehicle  the UAV  @param[out] out  its limits  @param size  sizeof *out
/// @return TETHER_OK or TETHER_INVALID
tether_status tether_get_flight_limits(const tether_vehicle* vehicle, tether_flight_limits* out,
                                       size_t size) TETHER_NOEXCEPT;

/// A joint that turns a part of the UAV with its sensors, as those of a gimbal do. The joints are a
/// chain from the body outwards. May grow.
typedef struct tether_joint {
  const char* name;       ///< owned by the vehicle
  tether_vec3 point_B_m;  ///< of its axis, while all joints are at 0
  tether_vec3 axis_B;     ///< of unit length, likewise; right-handed
  double min_rad;         ///< least angle
  double max_rad;         ///< largest angle
  double max_rate_rad_s;  ///< with which it turns to the angle that was commanded last
} tether_joint;

/// Number of joints.
/// @param vehicle  the UAV  @return the number; 0 if `vehicle` is NULL
size_t tether_joint_count(const tether_vehicle* vehicle) TETHER_NOEXCEPT;
/// A joint by its index. Never blocks.
/// @param vehicle  the UAV  @param index  from 0  @param[out] out  the joint  @param size  sizeof
/// *out
/// @return TETHER_OK, or TETHER_INVALID if `index` is not below tether_joint_count()
tether_status tether_get_joint(const tether_vehicle* vehicle, size_t index, tether_joint* out,
                               size_t size) TETHER_NOEXCEPT;

/// Follows set-points: one, or a trajectory. The UAV follows each from its time until that of the
/// next one, and the last until the next command, which ends a trajectory. An @ref interaction.
/// @param vehicle  the UAV  @param setpoints  1 to 1024; their times begin with 0 and increase
/// @param count  how many  @param size  sizeof *setpoints
/// @return TETHER_OK or an @ref interaction error; TETHER_INVALID, without an interaction, if a
/// mask
///   is no set-point, or if a value is not finite or beyond what the UAV can do
tether_status tether_follow(tether_vehicle* vehicle, const tether_setpoint* setpoints, size_t count,
                            size_t size) TETHER_NOEXCEPT;

/// @}

#ifdef __cplusplus
}
#endif
