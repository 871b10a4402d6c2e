#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// The search of `tether size`, whatever varies: flights at ordered levels until there is an
/// answer.
namespace tether::sizing {

/// What varies, as levels: level 0 asks the least of the computer.
class Axis {
 public:
  virtual ~Axis() = default;
  /// The levels of the next flights, at most so many; none: there is an answer.
  /// @param most 0: no more flights can be flown, or more would show nothing new.
  virtual std::vector<std::size_t> next_levels(std::size_t most) = 0;
  /// What flights have shown so far, for the progress.
  virtual std::string so_far() const = 0;
  /// Roughly how many flights are still needed, if that can be told.
  virtual std::optional<std::size_t> flights_left() const { return std::nullopt; }
};

/// A flight. Each has a seed of its own: flights with the same seed succeed and fail together, and
/// say less than their number.
struct Wanted {
  std::size_t level = 0;
  std::uint64_t seed = 1;

  friend bool operator==(const Wanted&, const Wanted&) = default;
};

/// What a flight turned out to be.
struct Flown {
  bool is_failed = false;    ///< which says nothing about the computer
  bool is_copy = false;      ///< of an earlier one at the same level
  bool lacks_value = false;  ///< missed a limit only because its metric has no value
};

/// Flies them. False: interrupted.
using FlyThem = std::function<bool(std::span<const Wanted>)>;
/// Gives a flight that has ended to the axis.
using TakeOne = std::function<Flown(const Wanted&)>;

/// With so many copies, the seeds change too little for an answer that is surer.
inline constexpr std::size_t kMostCopies = 20;

enum class SearchEnd {
  kAnswered,
  kInterrupted,  ///< the axis has the answer of the flights so far
  kFailing,      ///< flight after flight failed
  kUndecidable,  ///< no flight has a value for the limit
};
/// Takes the earlier flights, in their order, then flies until there is an answer: at most so many
/// in all, and so many at once.
SearchEnd search(Axis& axis, std::uint64_t most, std::size_t at_once,
                 std::span<const Wanted> earlier, const FlyThem& fly, const TakeOne& take);

// What `tether size` asks, and what it learns from each flight.

struct Question {
  double success = 0.9;      ///< the share of flights that must succeed, in (0, 1)
  double confidence = 0.95;  ///< of the threshold's interval, in (0, 1)
  double interval = 1.3;     ///< upper over lower bound at which the answer is narrow enough, > 1
  double least = 1.0;        ///< slowdowns to fly: between these, 0 < least < most
  double most = 40.0;
};

/// The slowdowns that may be flown: 10^(k/160), rounded to three digits, within the question's
/// range. Ascending.
std::vector<double> slowdowns_of(const Question& question);

/// The outcome of a flight.
struct Flight {
  double slowdown = 1.0;  ///< > 0
  bool reached = false;
  /// How far the worst limited metric was within its limit (negative: beyond), in shares of the
  /// limit; none if a metric has no value. Positive or zero exactly if `reached`.
  std::optional<double> margin{};

  friend bool operator==(const Flight&, const Flight&) = default;
};

/// An estimate with the bounds of its interval.
struct Estimate {
  double estimate = 0.0;
  double low = 0.0;
  double high = 0.0;
};
/// The largest slowdown at which the share of successful flights is still the wanted one.
using Threshold = Estimate;
/// Of flights that succeed.
using Share = Estimate;

// The answer where no curve fits: level by level, without assuming how the share falls.

/// A neighbourhood of slowdowns, and its flights.
struct Level {
  std::vector<double> slowdowns{};  ///< that may be flown, ascending, not empty
  std::size_t flights = 0;
  std::size_t reached = 0;
  Share share{};  ///< as exact_share; 0 to 1 without flights

  double middle() const { return slowdowns[slowdowns.size() / 2]; }
};

/// With the exact interval (Clopper & Pearson, Biometrika 26, 1934). @pre flights ≥ 1.
Share exact_share(std::size_t reached, std::size_t flights, double confidence);

/// All slowdowns of the question, in ascending order. A level is so wide that an interval that is
/// narrow enough spans two and a half of them.
std::vector<Level> levels_of(const Question& question, std::span<const Flight> flights,
                             double confidence);

struct LevelAnswer {
  /// The slowdown up to which each level is sufficient: the interval is from the largest level
  /// below the first insufficient one that is sufficient itself (its middle), to the end of that
  /// first one. A level is sufficient if its whole interval is at or above the wanted share, and
  /// insufficient if all of it is below. 0 and infinity: there is no such level.
  Threshold threshold{};
  Level next{};          ///< the level to fly next
  bool is_done = false;  ///< narrow enough, or no level between the bounds is worth more flights
};
LevelAnswer answer_by_levels(const Question& question, std::span<const Flight> flights);

// How the share of successful flights falls with the slowdown of a computer, from few flights.
//
// The curve is the psychometric function of Wichmann & Hill ("The psychometric function: I",
// Perception & Psychophysics 63, 2001): floor + (1 − floor − lapses) · logistic((middle − ln
// slowdown) / width). Its posterior is kept on a grid. The next flight is the one that is expected
// to reduce the threshold's variance most, as in the Ψ method (Kontsevich & Tyler, "Bayesian
// adaptive estimation of psychometric slope and threshold", Vision Research 39, 1999) and QUEST+
// (Watson, Journal of Vision 17, 2017); the other parameters are nuisances (Prins, "The
// psi-marginal adaptive method", Journal of Vision 13, 2013).

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

/// With fewer flights, chance outcomes would decide.
inline constexpr std::size_t kLeastFlights = 12;

/// On what an answer rests.
enum class Basis {
  kMargins,  ///< a curve that the margins of the flights fit, too
  kCurve,    ///< a curve that reached and missed goals fit
  kLevels,   ///< no curve fits: each neighbourhood of slowdowns for itself
};

struct Answer {
  Basis basis = Basis::kCurve;
  /// The estimate is within the question's range. A bound outside of it is not known: low is 0,
  /// high is infinity.
  Threshold threshold{};
  bool is_narrow = false;  ///< as narrow as asked, or wholly outside the range
  bool is_below = false;   ///< not even the least slowdown is sufficient
  bool is_above = false;   ///< the largest slowdown is sufficient
  double fit = 1.0;        ///< of the curve; of the last one that was rejected if kLevels
};

/// A neighbourhood of a slowdown is from the slowdown divided by this, to it times this. An answer
/// is about the share of success in neighbourhoods.
double neighbourhood_reach(const Question& question);

/// Finds the threshold flight by flight: which slowdowns to fly, when to stop, and the answer.
/// Prefers the curve with margins, then the one without, then levels: each is left for the next
/// when the flights do not fit it (SuccessCurve::fit). Its levels are the grid's slowdowns. Not
/// thread-safe.
class Sizing final : public Axis {
 public:
  /// @param has_margins whether flights have margins. @pre `grid` outlives the object.
  Sizing(const CurveGrid& grid, bool has_margins);

  void add(const Flight& flight);
  /// A flight was a copy of an earlier one at the same slowdown, which is no evidence.
  void skip_copy() { ++copies_; }
  std::span<const Flight> flights() const { return flights_; }
  /// The answer so far. Checks the fit once it would be final.
  /// @param is_last no more flights can be flown.
  Answer answer(bool is_last = false);
  /// The slowdowns of the next `count` flights. They are spread over a neighbourhood, so that the
  /// answer does not depend on what one slowdown does: success need not fall steadily (whole
  /// periods of a camera make steps). At an end of the range, the neighbourhood is inside of it.
  /// The spread depends on the number of flights before, and on nothing else. @pre answer() was not
  /// narrow enough.
  std::vector<double> next(std::size_t count) const;
  std::vector<std::size_t> next_levels(std::size_t most) override;
  std::string so_far() const override;
  /// The width of an interval falls with the square root of the number of flights.
  std::optional<std::size_t> flights_left() const override;
  /// As of the last call of `next_levels`.
  const Answer& latest() const { return latest_; }
  /// The curve of the answer; of kLevels, that of reached and missed goals.
  const SuccessCurve& curve() const;

 private:
  Answer current() const;

  const CurveGrid& grid_;
  SuccessCurve with_margins_, without_;
  std::vector<Flight> flights_;
  std::size_t copies_ = 0;
  Basis basis_;
  double fit_ = 1.0;
  Answer latest_{};
};

// How many UAVs a board carries: whole levels, each of which is sufficient or not. A board that
// carries some number of UAVs is taken to carry fewer as well.

/// Which numbers of UAVs are flown, and what each must reach.
struct UavQuestion {
  double success = 0.9;      ///< the share of flights that must succeed, in (0, 1)
  double confidence = 0.95;  ///< of the intervals, in (0, 1)
  std::size_t least = 1;     ///< 1 ≤ least ≤ most
  std::size_t most = 1;
};

/// The flights with one number of UAVs.
struct UavLevel {
  std::size_t uavs = 1;
  std::size_t flights = 0;
  std::size_t reached = 0;

  Share share(double confidence) const;  ///< with the exact interval. @pre flights ≥ 1
};

/// A level is sufficient if all of its exact interval is at or above the wanted share, and
/// insufficient if all of it is below.
struct UavAnswer {
  std::size_t carried = 0;   ///< the largest level known to be sufficient; least − 1: none is
  std::size_t too_many = 0;  ///< the smallest one known to be insufficient; most + 1: none is
  /// The levels to fly next, in this order and then from the front again; empty if nothing is
  /// between the two above. First by bisection, where few flights say on which side a level
  /// probably is; then the levels on both sides of the probable answer until they are decided, the
  /// one with fewer flights first.
  std::vector<std::size_t> next{};

  bool is_decided() const { return carried + 1 == too_many; }
};
/// @param levels those that were flown, in any order; each once.
UavAnswer answer_by_uavs(const UavQuestion& question, std::span<const UavLevel> levels);

/// Level i has `question.least` + i UAVs.
class UavAxis final : public Axis {
 public:
  explicit UavAxis(const UavQuestion& question);

  void add(std::size_t level, bool reached);
  /// As of the last call of `next_levels`.
  const UavAnswer& answer() const { return answer_; }
  std::vector<std::size_t> next_levels(std::size_t most) override;
  std::string so_far() const override;

 private:
  UavQuestion question_;
  std::vector<UavLevel> levels_{};
  UavAnswer answer_{};
};

}  // namespace tether::sizing
