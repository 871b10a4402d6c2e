#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <tether/sizing/search.h>

/// How many UAVs a board carries: whole levels, each of which is sufficient or not. A board that
/// carries some number of UAVs is taken to carry fewer as well.
namespace tether::sizing {

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
