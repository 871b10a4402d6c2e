#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tether/base/text_table.h>
#include <tether/timing/timing.h>

namespace tether::timing {

/// With fewer samples, quantiles of a stage say little.
inline constexpr std::size_t kFewSamples = 20;

/// The times of one stage. Times in seconds.
struct StageRow {
  std::string stage;
  std::size_t count = 0;
  double median_s = 0.0, p95_s = 0.0, p99_s = 0.0, worst_s = 0.0;
  double share = 0.0;  ///< of all computing
  friend bool operator==(const StageRow&, const StageRow&) = default;
};

/// The stages with the largest share first.
std::vector<StageRow> stage_rows(const Timing& timing);

/// One line for each stage with few samples.
std::vector<std::string> warnings(const std::vector<StageRow>& rows);

/// A time in milliseconds, for tables: "12.345".
std::string in_ms(double seconds);
/// For a person, in milliseconds; a list if the table is wider than `columns`.
std::string to_text(const std::vector<StageRow>& rows, std::size_t columns = kAnyColumns);

}  // namespace tether::timing
