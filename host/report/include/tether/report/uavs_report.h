#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <tether/campaign/campaign_results.h>
#include <tether/report/plots.h>
#include <tether/report/verdict.h>
#include <tether/sizing/by_levels.h>
#include <tether/sizing/by_uavs.h>

/// What `tether size --axis uavs` found: how many UAVs a board carries, in sentences, as a drawing,
/// a page and JSON. Pure functions, but for the drawing program of the page.
namespace tether::report {

/// The flights with the first so many UAVs of the scenario; none of them failed.
struct UavsPoint {
  std::size_t uavs = 1;
  std::vector<campaign::TrialResult> trials{};
};
/// What they say, with the exact interval of their share.
struct UavsLevel {
  sizing::UavLevel level{};
  sizing::Share share{};
};

struct UavsReport {
  std::string scenario{};
  std::string named{};  ///< the scenario for a command line (scenario::ShippedFiles::name_of)
  std::string condition{};
  std::string board{};  ///< name of the target that the UAVs share
  int cores = 1;        ///< of the board
  sizing::UavQuestion question{};
  std::size_t most_flights = 0;
  sizing::UavAnswer answer{};
  std::vector<UavsPoint> points{};  ///< those that were flown, in ascending order
  /// Of a flight with the fewest UAVs that are too many or, if there are none, with the most that
  /// were flown.
  PaceOrReason pace{};
  std::vector<std::string> not_flown{};  ///< one line for each flight that failed, with its reason
  campaign::Settings settings{};
};

std::vector<sizing::UavLevel> uav_levels(const std::vector<UavsPoint>& points);
/// Those of the report that were flown, in ascending order.
std::vector<UavsLevel> levels_of(const UavsReport& report);
PaceOrReason pace_at_limit(const UavsReport& report);
std::size_t flights_of(const UavsReport& report);
/// Of these, copies of other ones with as many UAVs, which do not count.
std::size_t copies_in(const UavsReport& report);

/// Whether the number of UAVs is known, and at least the least one that was asked for.
bool is_answered(const UavsReport& report);
/// The answer with its evidence, then what limits it.
std::vector<Answer> uavs_answers(const UavsReport& report);
/// What to do next; each one sentence.
std::vector<std::string> uavs_advice(const UavsReport& report);
/// The share of flights that reach the goal over the number of UAVs, with exact intervals.
Plot uavs_plot(const UavsReport& report);
/// One self-contained page. @throws Error(kSetup) if gnuplot is missing or fails.
std::string uavs_page(const UavsReport& report);
/// The content of `size.json` (docs/guide/size.md).
std::string uavs_json(const UavsReport& report);
/// One case, which fails if the answer is not decided. @param folder of the flights
std::string to_junit(const UavsReport& report, const std::filesystem::path& folder);

}  // namespace tether::report
