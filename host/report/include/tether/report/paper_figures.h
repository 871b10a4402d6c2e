#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

/// The paper's own results, to stand beside ours. Data only.
namespace tether::report {

struct PaperFigure {
  std::string_view condition;    ///< by our names: "host", "target", "target, no sync"
  std::string_view metric_kind;  ///< by our names: "time_required", …
  double mean = 0.0;             ///< in the metric's unit
  std::optional<double> stddev;  ///< where the paper gives one
  /// Where a table has two metrics of one kind, the name that ours must have; empty: any name.
  std::string_view metric_name = "";
};

struct PaperTable {
  std::string_view number;  ///< "I" to "V"
  std::string_view title;
  std::string_view source;  ///< where it stands
  std::span<const PaperFigure> figures;

  /// nullptr where the paper gives none.
  const PaperFigure* find(std::string_view condition, std::string_view metric_kind,
                          std::string_view metric_name) const;
  /// Whether the paper has this metric, under whatever condition.
  bool has_metric(std::string_view metric_kind, std::string_view metric_name) const;
  /// Each once, in the paper's order.
  std::vector<std::string_view> conditions() const;
};

/// nullptr where there is none of that number.
const PaperTable* find_paper_table(std::string_view number);

}  // namespace tether::report
