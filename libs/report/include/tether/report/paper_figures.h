#pragma once

#include <optional>
#include <span>
#include <string_view>

/// The paper's own results, to stand beside ours. Data only.
namespace tether::report {

struct PaperFigure {
  std::string_view condition;    ///< by our names: "host", "target", "target, no sync"
  std::string_view metric_kind;  ///< by our names: "time_required", …
  double mean = 0.0;             ///< in the metric's unit
  std::optional<double> stddev;  ///< where the paper gives one
};

struct PaperTable {
  std::string_view number;  ///< "II" to "V"
  std::string_view title;
  std::string_view source;  ///< where it stands
  std::span<const PaperFigure> figures;

  /// nullptr where the paper gives none.
  const PaperFigure* find(std::string_view condition, std::string_view metric_kind) const;
};

/// nullptr where there is none of that number.
const PaperTable* find_paper_table(std::string_view number);

}  // namespace tether::report
