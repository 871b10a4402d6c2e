#pragma once

#include "command_line.h"
#include "connection.h"

#include <iosfwd>

/// What the program does once its words are understood: results to `out`, words about what went
/// wrong to `err`; each returns the exit code.
namespace tether::sut {

struct Streams {
  std::ostream& out;
  std::ostream& err;
};

/// Flies the mission and prints its details as one line of JSON.
int fly_command(const CommandLine& line, client::Vehicle& vehicle, const Streams& streams);

/// Measures the row "Real sensor" of Table II and prints it before the JSON line, if the task
/// reached its goal. The image is written, if asked for, whenever the anchor was seen.
/// @pre line.mission is one relative_position task
int real_row_command(const CommandLine& line, const Connection& connection, const Streams& streams);

/// Characterizes, writes the profile, tells the coordinator, and prints Table I, the distributions,
/// which timing model each sensor got, and the JSON line. Where anything fails no profile is
/// written.
/// @pre line.characterize
int characterize_command(const CommandLine& line, const Connection& connection,
                         const Streams& streams);

/// Calibrates and prints the tables.
int calibrate_command(const calibration::CalibrateOptions& options, const Streams& streams);

/// The whole: checks that the files can be written, connects, and runs the command.
int run_command(const CommandLine& line, const Streams& streams);

}  // namespace tether::sut
