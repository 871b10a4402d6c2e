#pragma once

#include "command_line.h"

#include <memory>

#include <tether/base/result.h>
#include <tether/calibration/sensor_table.h>
#include <tether/client/vehicle.h>

namespace tether::sut {

/// What the SUT works with, and how the paper's tables name it.
struct Connection {
  std::unique_ptr<client::Vehicle> vehicle;
  calibration::Origin origin;
  bool is_real = false;
};

/// Opens the rig's devices, or connects to the coordinator that the command line or the environment
/// names. With real devices an interrupt then ends the vehicle's calls (`make_interruptible`). A
/// device that cannot be opened is kRefused: the set-up failed.
Result<Connection> connect_as(const CommandLine& line);

/// Where a file is to be written: a relative path is below the folder of the run that started this
/// program (TETHER_OUT), if one did.
std::string in_run_folder(const std::string& path);

}  // namespace tether::sut
