#pragma once

#include "command_line.h"
#include "connection.h"

#include <iosfwd>

/// The commands of the program. Results go to `out`, errors and notes to `err`; each returns the
/// exit code.
namespace tether::sut {

struct Streams {
  std::ostream& out;
  std::ostream& err;
};

/// Runs the mission and prints its details as one line of JSON.
int fly_command(const CommandLine& line, client::Vehicle& vehicle, const Streams& streams);

/// Measures the row "Real sensor" of Table II. Prints it before the JSON line if the task reached
/// its goal. Writes the image, if requested, if the anchor was seen.
/// @pre line.mission is one relative_position task
int real_row_command(const CommandLine& line, const Connection& connection, const Streams& streams);

/// Characterizes the sensors, writes the profile, finishes the run, and prints Table I, the
/// distributions, the timing model of each sensor, and the JSON line. Writes no profile if anything
/// fails.
/// @pre line.characterize
int characterize_command(const CommandLine& line, const Connection& connection,
                         const Streams& streams);

/// Calibrates this machine and prints the tables.
int calibrate_command(const calibration::CalibrateOptions& options, const Streams& streams);

/// Checks that the output files can be written, connects, and runs the command.
int run_command(const CommandLine& line, const Streams& streams);

}  // namespace tether::sut
