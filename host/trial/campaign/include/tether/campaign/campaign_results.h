#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/result.h>
#include <tether/record/reader.h>

/// Flights of several seeds that are one flight, because their seeds change nothing. Only distinct
/// flights are evidence of how often a goal is reached. Pure functions.
namespace tether::campaign {

/// Digest of the true states of all UAVs at each sample of the ground truth (FNV-1a, 64 bits, 16
/// hexadecimal digits): two runs have the same if every UAV moved in the same way, to the last bit.
/// Empty without a ground truth.
std::string flight_digest(const record::Record& record);

/// Whether both are one flight, flown twice: the same true states, outcome, metrics and clauses.
/// Results of earlier versions have no digest, and are never copies.
bool are_copies(const TrialResult& a, const TrialResult& b);

/// Those that have a result, each flight once, in their order. The trials must outlive it.
std::vector<const TrialResult*> distinct_flights(std::span<const TrialResult> trials);

// Statistics of small samples. Pure functions; all values must be finite.

struct Interval {
  double low = 0.0;
  double high = 0.0;
  friend bool operator==(const Interval&, const Interval&) = default;
};

struct Summary {
  std::size_t n = 0;
  double mean = 0.0;  ///< @pre of this and the next three: n ≥ 1
  double median = 0.0;
  double min = 0.0;
  double max = 0.0;
  std::optional<double> stddev;  ///< of the sample (n − 1); n ≥ 2
  std::optional<Interval> ci95;  ///< of the mean, by Student's t; n ≥ 2
};
Summary summarise(std::span<const double> values);

/// How much larger the mean of `a` is than that of `b`, without assuming equal variances.
struct MeanDifference {
  double difference = 0.0;          ///< mean(a) − mean(b)
  std::optional<Interval> ci95;     ///< Welch's t interval; each n ≥ 2
  double degrees_of_freedom = 0.0;  ///< Welch-Satterthwaite; 0 where neither sample varies
};
/// @pre neither is empty.
MeanDifference compare_means(std::span<const double> a, std::span<const double> b);

/// The Mann-Whitney U (Wilcoxon rank-sum) test: whether one of two samples tends to be larger.
/// It suits small and skewed samples: no distribution is assumed, and up to 100 values in all the
/// p-value is exact, also with ties (the permutation distribution of the mid-ranks).
struct RankTest {
  double u = 0.0;  ///< of `a`: pairs in which a's value is larger, plus half the tied ones
  double p_two_sided = 1.0;  ///< twice the smaller tail, at most 1
  bool exact = true;  ///< false: normal approximation with corrections for ties and continuity
};
/// @pre neither is empty.
RankTest mann_whitney(std::span<const double> a, std::span<const double> b);

/// How many of how many.
struct Count {
  std::size_t of_them = 0;
  std::size_t all = 0;
};
/// Fisher's exact test, two-sided: the probability of a split between both samples that is no more
/// likely than this one, if their shares are equal. 1 if a sample is empty.
double fisher_exact(const Count& a, const Count& b);

/// P-values corrected for their number by Holm's step-down method, in their order: those below a
/// level are significant, with at most that probability of any false one.
std::vector<double> holm(std::span<const double> p_values);

// All results of a campaign, from its folder alone.

struct ConditionResults {
  std::string condition;
  std::vector<TrialResult> trials;  ///< those that have a result, in order of the seeds
  std::size_t planned = 0;          ///< trials in the campaign's plan

  /// The values of a metric over those distinct flights (copies.h) that have one.
  std::vector<double> values(std::string_view metric) const;
  std::size_t count(Outcome outcome) const;
};

struct ScenarioResults {
  std::string scenario;
  std::string description;
  std::string paper_table;  ///< empty: none
  std::vector<std::string> metrics;
  std::vector<ConditionResults> conditions;
  /// As in CampaignManifest::Entry.
  std::string swept_from{};
  std::vector<Setting> settings{};

  const ConditionResults* find_condition(std::string_view condition) const;
  /// Label, kind and unit of a metric, from any trial; nullptr if there is no trial.
  const MetricValue* find_metric(std::string_view metric) const;
};

struct CampaignResults {
  CampaignManifest manifest;
  std::vector<ScenarioResults> scenarios;
  std::vector<std::string> damaged;  ///< one line for each result that exists but is unreadable
};

/// @throws Error(kBadFile) if the folder contains no campaign.
CampaignResults read_campaign_results(const std::filesystem::path& folder);

}  // namespace tether::campaign
