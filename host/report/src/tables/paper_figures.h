#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

/// The results in the paper, for comparison with ours. Data only.
namespace tether::report {

struct PaperFigure {
  std::string_view condition;    ///< our name: "host", "target", "target, no sync"
  std::string_view metric_kind;  ///< our name: "time_required", …
  double mean = 0.0;             ///< in the metric's unit
  std::optional<double> stddev;  ///< none if the paper gives none
  /// The name of our metric, if a table has two metrics of one kind; empty: any name.
  std::string_view metric_name = "";
};

/// The condition without ", counted", which only says how its time is measured: "host, counted" is
/// compared with the paper's "host".
std::string_view without_clock(std::string_view condition);

struct PaperTable {
  std::string_view number;  ///< "I" to "V"
  std::string_view title;
  std::string_view source;  ///< the place in the paper
  std::span<const PaperFigure> figures;

  /// nullptr if the paper gives none.
  const PaperFigure* find(std::string_view condition, std::string_view metric_kind,
                          std::string_view metric_name) const;
  /// Whether the table has this metric under any condition.
  bool has_metric(std::string_view metric_kind, std::string_view metric_name) const;
  /// Each once, in the paper's order.
  std::vector<std::string_view> conditions() const;
};

/// nullptr if there is no table of that number.
const PaperTable* find_paper_table(std::string_view number);

}  // namespace tether::report
