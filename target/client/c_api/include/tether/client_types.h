#pragma once

/// @defgroup c_values Vectors and poses
/// @ingroup c_api
/// Small structs that never grow.
/// @{

/// A vector. Unit and frame are named where it is used.
typedef struct tether_vec3 {
  double x;  ///< ahead in B, H and S; east in W
  double y;  ///< left in B, H and S; north in W
  double z;  ///< up
} tether_vec3;

/// Unit quaternion, Hamilton convention.
typedef struct tether_quat {
  double w;  ///< scalar part
  double x;  ///< vector part, x
  double y;  ///< vector part, y
  double z;  ///< vector part, z
} tether_quat;

/// X_PF: the pose of a frame F in its parent P.
typedef struct tether_pose {
  tether_vec3 position_m;  ///< of F's origin, in P
  tether_quat attitude;    ///< q_PF
} tether_pose;

/// @}
