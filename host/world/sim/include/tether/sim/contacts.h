#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/time.h>

namespace tether::sim {

/// A UAV has begun to touch something.
struct Contact {
  SimTime at;           ///< the step boundary at which both touch for the first time
  std::size_t uav = 0;  ///< index in `World::uavs`
  std::string with;     ///< name of the model or UAV that it touches
  /// Speed at which both approached each other along the contact's normal, just before the impact
  /// [m/s], ≥ 0. A UAV that slides along a wall has a speed near 0.
  double speed_m_s = 0.0;
  friend bool operator==(const Contact&, const Contact&) = default;
};

/// A collision shape that a UAV touches at a step boundary.
struct Touch {
  SimTime at;
  std::size_t uav = 0;
  std::string_view with;   ///< must outlive the log
  std::int64_t shape = 0;  ///< a number of the shape that is touched, unique in `with`
  double speed_m_s = 0.0;  ///< as Contact::speed_m_s; ≤ 0: both depart
};

/// Makes contacts of the touches of every step. What touches again within kSameContact after it
/// was last touched is still the same contact. Several shapes of one model (boards of a shelf, the
/// floor and a wall of a room) are one contact, unless a later one is hit harder than those that
/// the UAV already touches.
class ContactLog {
 public:
  /// Too short for a UAV to fall, bounce or accelerate to a speed that would hide a crash.
  static constexpr Duration kSameContact = std::chrono::milliseconds(100);

  ContactLog();

  /// All touches of a step boundary, before those of the next one. Allocates only if there are
  /// many.
  void add(const Touch& touch);
  /// The contacts that began since the last call, in the order of time. Call between two steps.
  std::vector<Contact> take();
  void reset();

 private:
  struct Touched {
    Touch first;  ///< with the greatest speed of its instant
    SimTime last;
  };

  void begin(const Touch& touch);

  std::vector<Touched> touched_;
  std::vector<Touch> begun_;
};

}  // namespace tether::sim
