#pragma once

#include <tether/client.h>

/// @cond
#ifdef __cplusplus
extern "C" {
#endif
/// @endcond

/// @defgroup c_subscribing Subscriptions
/// @ingroup c_api
/// A thread of the library reads a periodic sensor continuously, as TETHER_READ_NEXT does, and
/// calls the program with each measurement at the ET at which it is available. The callback runs in
/// that thread with every signal blocked. It can call the vehicle, and must not throw. What it
/// receives is valid until it returns. If measurements arrive while it runs, it receives the newest
/// of them afterwards. Measurements that other threads read from the same sensor are not delivered.
///
/// A subscription needs tether-exec.
/// @{

/// Measurements that are delivered to a callback.
typedef struct tether_subscription tether_subscription;
/// Receives an image. @param image  valid until the return  @param user  as subscribed
typedef void (*tether_on_image)(const tether_image* image, void* user);
/// Receives a sample. @param sample  valid until the return  @param user  as subscribed
typedef void (*tether_on_imu)(const tether_imu_sample* sample, void* user);
/// Receives a sample. @param sample  valid until the return  @param user  as subscribed
typedef void (*tether_on_range)(const tether_range_sample* sample, void* user);
/// Receives a sample. @param sample  valid until the return  @param user  as subscribed
typedef void (*tether_on_navsat)(const tether_navsat_sample* sample, void* user);
/// Receives a sample. @param sample  valid until the return  @param user  as subscribed
typedef void (*tether_on_magnetometer)(const tether_magnetometer_sample* sample, void* user);
/// Receives a sample. @param sample  valid until the return  @param user  as subscribed
typedef void (*tether_on_barometer)(const tether_barometer_sample* sample, void* user);
/// Receives a sample. @param sample  valid until the return  @param user  as subscribed
typedef void (*tether_on_odometry)(const tether_odometry_sample* sample, void* user);
/// Receives a sample. @param sample  valid until the return  @param user  as subscribed
typedef void (*tether_on_joint_state)(const tether_joint_state_sample* sample, void* user);
/// Receives a scan. @param scan  valid until the return  @param user  as subscribed
typedef void (*tether_on_scan)(const tether_scan* scan, void* user);

/// Subscribes to a camera.
/// @param vehicle  the UAV  @param sensor  name of a periodic camera
/// @param on_image  is called with each image  @param user  is passed to it; may be NULL
/// @param[out] out  the subscription; end it with tether_unsubscribe()
/// @return TETHER_OK; TETHER_INVALID if tether_is_concurrent() is 0, the UAV has no such sensor, or
///   the sensor measures on demand
tether_status tether_subscribe_camera(tether_vehicle* vehicle, const char* sensor,
                                      tether_on_image on_image, void* user,
                                      tether_subscription** out) TETHER_NOEXCEPT;
/// Subscribes to an IMU.
/// @param vehicle  the UAV  @param sensor  name of a periodic sensor of this kind
/// @param on_sample  is called with each sample  @param user  is passed to it; may be NULL
/// @param[out] out  the subscription; end it with tether_unsubscribe()
/// @return as tether_subscribe_camera()
tether_status tether_subscribe_imu(tether_vehicle* vehicle, const char* sensor,
                                   tether_on_imu on_sample, void* user,
                                   tether_subscription** out) TETHER_NOEXCEPT;
/// Subscribes to a rangefinder. @copydetails tether_subscribe_imu
tether_status tether_subscribe_range(tether_vehicle* vehicle, const char* sensor,
                                     tether_on_range on_sample, void* user,
                                     tether_subscription** out) TETHER_NOEXCEPT;
/// Subscribes to a receiver of satellite navigation. @copydetails tether_subscribe_imu
tether_status tether_subscribe_navsat(tether_vehicle* vehicle, const char* sensor,
                                      tether_on_navsat on_sample, void* user,
                                      tether_subscription** out) TETHER_NOEXCEPT;
/// Subscribes to a magnetometer. @copydetails tether_subscribe_imu
tether_status tether_subscribe_magnetometer(tether_vehicle* vehicle, const char* sensor,
                                            tether_on_magnetometer on_sample, void* user,
                                            tether_subscription** out) TETHER_NOEXCEPT;
/// Subscribes to a barometer. @copydetails tether_subscribe_imu
tether_status tether_subscribe_barometer(tether_vehicle* vehicle, const char* sensor,
                                         tether_on_barometer on_sample, void* user,
                                         tether_subscription** out) TETHER_NOEXCEPT;
/// Subscribes to estimates of pose and velocity. @copydetails tether_subscribe_imu
tether_status tether_subscribe_odometry(tether_vehicle* vehicle, const char* sensor,
                                        tether_on_odometry on_sample, void* user,
                                        tether_subscription** out) TETHER_NOEXCEPT;
/// Subscribes to the angles of all joints. @copydetails tether_subscribe_imu
tether_status tether_subscribe_joint_state(tether_vehicle* vehicle, const char* sensor,
                                           tether_on_joint_state on_sample, void* user,
                                           tether_subscription** out) TETHER_NOEXCEPT;
/// Subscribes to a lidar.
/// @param vehicle  the UAV  @param sensor  name of a periodic lidar
/// @param on_scan  is called with each scan  @param user  is passed to it; may be NULL
/// @param[out] out  the subscription; end it with tether_unsubscribe()
/// @return as tether_subscribe_camera()
tether_status tether_subscribe_scan(tether_vehicle* vehicle, const char* sensor,
                                    tether_on_scan on_scan, void* user,
                                    tether_subscription** out) TETHER_NOEXCEPT;
/// Whether measurements still arrive. Never blocks.
/// @param subscription  the subscription
/// @return TETHER_OK if they do; else why none will arrive, for instance TETHER_RUN_ENDED
tether_status tether_subscription_status(const tether_subscription* subscription) TETHER_NOEXCEPT;
/// Ends a subscription. After the return no callback runs, except one that calls this itself. Must
/// be called before tether_disconnect(). @param subscription  the subscription, or NULL
void tether_unsubscribe(tether_subscription* subscription) TETHER_NOEXCEPT;

/// @}

#ifdef __cplusplus
}
#endif
