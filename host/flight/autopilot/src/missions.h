#pragma once

#include "outbox.h"
#include "vehicle.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tether/mavlink/frame.h>

namespace tether::autopilot {

/// An item of a mission (MAV_CMD).
struct MissionItem {
  int frame = 0;
  int command = 0;
  bool goes_on = true;
  double parameters[4] = {};  // NaN: none
  double latitude_deg = 0.0, longitude_deg = 0.0, z_m = 0.0;
};

/// MAV_CMD of items.
inline constexpr int kWaypoint = 16, kLoiterUnlimited = 17, kLoiterTime = 19, kReturnToLaunch = 20,
                     kLandItem = 21, kTakeoffItem = 22, kDelay = 93, kChangeSpeed = 178;

/// An item of a plan: each upload is another plan.
struct MissionPlace {
  std::uint64_t plan = 0;
  std::size_t item = 0;
  friend bool operator==(const MissionPlace&, const MissionPlace&) = default;
};

/// The plan of a mission: upload, download and progress (MAVLink's mission protocol,
/// mavlink.io/en/services/mission.html). Flying it is the Navigator's.
class Missions {
 public:
  static bool takes(const mavlink::Message& message);
  void on_message(const mavlink::Frame& frame, const Vehicle& vehicle, Outbox& outbox);
  /// Asks again for an item of an upload that does not come.
  void step(SimTime now, Outbox& outbox);

  const std::vector<MissionItem>& items() const { return items_; }
  MissionPlace current() const { return {plan_, current_}; }
  /// Tells that the current item was reached.
  void say_reached(Outbox& outbox) const;
  /// Goes on to the next item. False: it was the last one.
  bool go_on(Outbox& outbox);
  void restart() { current_ = 0; }
  /// False: there is no such item.
  bool go_to(std::size_t item);
  bool is_at_end() const { return current_ >= items_.size(); }
  /// The number of the current item, or of the last one.
  std::size_t shown() const { return is_at_end() && current_ > 0 ? items_.size() - 1 : current_; }
  void send_current(Outbox& outbox) const;

 private:
  struct Upload {
    mavlink::Address from;
    std::size_t count = 0;
    std::vector<MissionItem> items;
    SimTime asked_at{};
    int tries = 0;
  };
  void begin_upload(const mavlink::Frame& frame, SimTime now, Outbox& outbox);
  void take_item(const mavlink::Frame& frame, SimTime now, Outbox& outbox);
  void ask(SimTime now, Outbox& outbox);
  void replace(std::vector<MissionItem> items);
  void send_item(const mavlink::Frame& request, bool as_integers, Outbox& outbox) const;

  std::vector<MissionItem> items_;
  std::uint64_t plan_ = 0;
  std::size_t current_ = 0;
  std::optional<Upload> upload_;
};

}  // namespace tether::autopilot
