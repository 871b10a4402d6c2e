#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tether/record/reader.h>
#include <tether/report/table.h>

namespace tether::report {

/// The messages from one UAV to another.
struct RadioLink {
  std::size_t messages = 0, delivered = 0;
  std::map<std::string, std::size_t> lost;  ///< by cause
  std::vector<double> delays_s;             ///< of those that arrived, sorted
  std::vector<double> distances_m;          ///< of those that were transmitted

  /// Without messages that were still waiting at the end; none: there are no others.
  std::optional<double> delivery_ratio() const;
};
/// By sender and receiver.
using RadioLinks = std::map<std::pair<std::string, std::string>, RadioLink>;
RadioLinks radio_links(const record::Record& record);

/// A row for each link. No rows: nothing was sent.
Table radio_table(const record::Record& record);

}  // namespace tether::report
