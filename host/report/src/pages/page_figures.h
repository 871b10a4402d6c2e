#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <tether/campaign/campaign_results.h>
#include <tether/record/reader.h>
#include <tether/report/plots.h>

/// The figures of a page as HTML.
namespace tether::report {

/// Draws for one page: ids are unique, and the size of camera frames is limited so that the page
/// stays below 8 MB.
class FigureMaker {
 public:
  /// @param frame_groups number of calls of `frames`, which share the limit equally.
  explicit FigureMaker(std::size_t frame_groups);
  /// Empty if there is no plot.
  std::string plot(const std::optional<Plot>& plot, const std::string& caption);
  /// At most four of the record's images, of its depths and of its labels each, evenly over the
  /// run; empty if it has none.
  std::string frames(const record::Record& record) const;

 private:
  std::size_t figures_ = 0;
  std::size_t bytes_per_group_;
};

/// The records of one seed: one for each condition that has a record.
struct SeedRecords {
  struct OfCondition {
    std::size_t series = 0;  ///< the condition's place in its scenario
    std::string condition;
    record::Record record;
  };
  std::vector<OfCondition> records;
  std::vector<std::string> unreadable;  ///< one line each
};

/// Of the first seed that has a record under every condition; otherwise, the first of each
/// condition.
SeedRecords read_seed_records(const campaign::ScenarioResults& scenario,
                              const std::filesystem::path& folder);

}  // namespace tether::report
