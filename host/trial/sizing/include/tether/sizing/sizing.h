#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <tether/sizing/by_levels.h>
#include <tether/sizing/search.h>
#include <tether/sizing/success_curve.h>

namespace tether::sizing {

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

}  // namespace tether::sizing
