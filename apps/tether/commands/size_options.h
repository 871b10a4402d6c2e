#pragma once

#include "options/common_options.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tether::app {

/// What `tether size` leaves in its folder, beside the page and the flights.
inline constexpr const char* kSizeFile = "size.json";
inline constexpr const char* kSizeDrawing = "size.svg";

struct SizeOptions {
  std::filesystem::path scenario;
  std::string axis = "slowdown";  ///< or "uavs"
  std::string condition;
  std::string unsynchronised;
  std::vector<std::filesystem::path> targets;
  std::filesystem::path out;
  std::string simulator;
  double success = 0.9;
  double confidence = 0.95;
  std::optional<double> interval;
  std::optional<std::vector<double>> between;
  std::uint64_t max_trials = 300;
  EngineOptions engine;
  ReadingOptions reading;
  bool resume = false;
  bool force = false;
  std::filesystem::path junit;
};

}  // namespace tether::app
