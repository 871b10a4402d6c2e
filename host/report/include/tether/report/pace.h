#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <tether/record/reader.h>
#include <tether/timing/stage_table.h>

namespace tether::report {

/// How fast the program of one run worked, and on what it spent its computing time.
struct Pace {
  std::string uav{};
  std::uint64_t seed = 0;
  std::vector<timing::StageRow> stages{};  ///< the largest share first

  // Of the camera that was read most often. If none was read twice: empty, 0 and none.
  std::string camera{};
  std::size_t images = 0;
  double read_hz = 0.0;                ///< one over the median ST between two images
  std::optional<double> offered_hz{};  ///< none if the camera has no rate of its own
  double median_s = 0.0;               ///< computing per image: ET between two images
  double p95_s = 0.0;                  ///< of 95 % of the images

  /// How many times slower the program could compute, and still 95 % of its images would take no
  /// longer than the camera's period. None without a camera with a rate.
  std::optional<double> headroom() const;
  /// Whether the program reads (nearly) every image that the camera offers.
  bool keeps_up() const;
};

/// Of the SUT that computes most for an image. None if the run was not synchronised (its computing
/// times are not known), or has no interactions.
std::optional<Pace> pace_of(const record::Record& record);

/// Of a record on the disk. @throws Error(kBadFile), about the file, if it is missing, unreadable,
/// or damaged.
std::optional<Pace> read_pace(const std::filesystem::path& file);

}  // namespace tether::report
