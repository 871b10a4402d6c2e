#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <tether/sizing/search.h>

/// How the share of successful flights falls with the slowdown of a computer, from few flights.
///
/// The curve is the psychometric function of Wichmann & Hill ("The psychometric function: I",
/// Perception & Psychophysics 63, 2001): floor + (1 − floor − lapses) · logistic((middle − ln
/// slowdown) / width). Its posterior is kept on a grid. The next flight is the one that is expected
/// to reduce the threshold's variance most, as in the Ψ method (Kontsevich & Tyler, "Bayesian
/// adaptive estimation of psychometric slope and threshold", Vision Research 39, 1999) and QUEST+
/// (Watson, Journal of Vision 17, 2017); the other parameters are nuisances (Prins, "The
/// psi-marginal adaptive method", Journal of Vision 13, 2013).
namespace tether::sizing {

/// The curves that are considered, and what is the same for every set of flights.
class CurveGrid {
 public:
  explicit CurveGrid(const Question& question);

  const Question& question() const { return question_; }
  /// The slowdowns that may be flown: slowdowns_of(question()).
  const std::vector<double>& slowdowns() const { return slowdowns_; }

 private:
  friend class SuccessCurve;
  struct Ends {
    double lapses = 0.0, floor = 0.0;  // of all flights: missed, and reached, whatever the slowdown
    double prior = 0.0;
  };
  // Ordered by middle, then width, then ends.
  struct Curve {
    double middle = 0.0, width = 0.0;  // log slowdown
    const Ends* ends = nullptr;
    double follows(double log_slowdown) const;  // without lapses and floor
    double share(double log_slowdown) const;
  };
  void add_curve(double middle, double width, const Ends& ends, double first, double last);

  Question question_;
  std::vector<double> slowdowns_;
  std::vector<double> planned_;  // of slowdowns_, those that next_slowdowns chooses from
  std::vector<double> middles_, widths_;
  std::vector<Ends> ends_;
  std::vector<Curve> curves_;
  std::vector<float> threshold_;           // of each curve, log slowdown
  std::vector<std::size_t> by_threshold_;  // indices of curves
  // Of each planned slowdown and each pair of middle and width: logistic((middle − x) / width).
  std::vector<std::vector<float>> follows_;

 public:
  CurveGrid(const CurveGrid&) = delete;
  CurveGrid& operator=(const CurveGrid&) = delete;
};

/// The posterior of the curve. Not thread-safe. Equal flights in equal order give equal results.
class SuccessCurve {
 public:
  enum class Margins {
    kIgnored,
    /// Near the limit, the margin falls linearly with the log slowdown, with logistic noise of
    /// constant width; its sign is the outcome. A margin beyond half of the limit only counts as
    /// such.
    kLinear,
  };
  /// @pre `grid` outlives the object.
  SuccessCurve(const CurveGrid& grid, Margins margins);

  void observe(const Flight& flight);
  /// The median, and the interval with the question's confidence and equal tails. A bound at or
  /// beyond the question's range only says that it lies there.
  Threshold threshold() const;
  /// Of successful flights at a slowdown: the mean, and an interval as above.
  Share share(double slowdown) const;
  /// The slowdowns to fly next, one for each of `count` flights that are flown at the same time.
  /// After each of them, its expected outcome is taken as observed.
  std::vector<double> next_slowdowns(std::size_t count) const;
  /// Posterior predictive check (Gelman, Meng & Stern, Statistica Sinica 6, 1996): the probability
  /// that flights of such curves at the same slowdowns deviate from their curve as much as these
  /// do, whichever is least likely (times 3, as for three tests): χ² over groups of slowdowns and
  /// kinds of outcomes, of all groups or of the one that deviates most; or how alike the outcomes
  /// of neighbours in slowdown are, which tells of steps that are narrower than a group. Small: the
  /// flights are not of such a curve.
  double fit(std::span<const Flight> flights) const;

 private:
  void normalise();

  const CurveGrid& grid_;
  std::size_t scales_;  // of the margin; 1 if it is ignored
  // Of curve and scale: [(pair * scales_ + scale) * ends + end], where pair is of middle and width;
  // sums to 1.
  std::vector<float> joint_;
  std::vector<char> is_kept_;  // [pair * scales_ + scale]: false if it has no weight any more
  std::vector<float> weight_;  // of each curve; sums to 1
  mutable std::optional<Threshold> threshold_{};  // once it was asked for
};

}  // namespace tether::sizing
