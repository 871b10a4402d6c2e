#pragma once

#include "command_line.h"

#include <memory>

#include <tether/base/result.h>
#include <tether/calibration/characterize.h>
#include <tether/client/vehicle.h>

namespace tether::sut {

/// The vehicle of a command, and its name in the tables of the paper.
struct Connection {
  std::unique_ptr<client::Vehicle> vehicle;
  calibration::Origin origin;
  bool is_real = false;
};

/// Opens the devices of the rig, or connects to the coordinator of the command line or the
/// environment. With real devices, an interrupt ends calls of the vehicle (`make_interruptible`).
/// Fails with kRefused if a device cannot be opened.
Result<Connection> connect_as(const CommandLine& line);

/// The path of an output file: a relative path is below TETHER_OUT, if that is set.
std::string in_run_folder(const std::string& path);

}  // namespace tether::sut
