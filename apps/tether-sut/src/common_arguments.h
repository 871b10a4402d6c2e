#pragma once

#include "mission.h"

#include <string>

#include <CLI/CLI.hpp>

#include <tether/base/units.h>

/// Groups of options that several tasks have.
namespace tether::sut {

/// Like CLI::Range, which lets NaN through.
CLI::Validator within(double least, double most);

/// An option in seconds, usually at least a millisecond, for what the tasks keep as a Duration.
CLI::Option* add_seconds(CLI::App& app, const std::string& name, Duration& duration,
                         const std::string& description, double least_s = 0.001);
/// An option in degrees, for an angle or a rate that the tasks keep in radians.
CLI::Option* add_degrees(CLI::App& app, const std::string& name, double& radians,
                         const std::string& description, double least_deg, double most_deg);

/// --anchor, --camera and what the tracker looks for.
void add_vision_options(CLI::App& app, TaskSpec& spec);
/// When an estimate has converged.
void add_convergence_options(CLI::App& app, tasks::ConvergenceOptions& options);
/// How "face anchor" turns; neither its precision nor its time limit.
void add_turning_options(CLI::App& app, tasks::FaceAnchorOptions& options);

}  // namespace tether::sut
