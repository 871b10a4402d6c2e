#pragma once

#include "camera/camera_device.h"
#include "clock.h"
#include "system.h"

#include <memory>
#include <string>

#include <tether/base/result.h>
#include <tether/devices/rig.h>

namespace tether::devices {

/// Opens the sensor's device, and completes its description by it: the size where the width is 0,
/// the rate where it is 0. A live camera has given an image then. Fails with kInvalid; the message
/// is a line that begins with `label`. @pre the sensor is a camera
Result<std::unique_ptr<CameraDevice>> open_camera(System& system, const Timeline& time,
                                                  const std::string& label, RigSensor& sensor);

}  // namespace tether::devices
