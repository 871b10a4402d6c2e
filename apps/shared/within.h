#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace tether::app {

/// A number for people: 25, not 25.000000000000004.
std::string shown(double value);

/// Like CLI::Range, but rejects NaN, and shows the limits as they are written.
CLI::Validator within(double least, double most);

}  // namespace tether::app
