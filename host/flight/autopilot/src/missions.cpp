#include "missions.h"

#include "command.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tether::autopilot {
namespace {

constexpr std::size_t kMostItems = 1000;
constexpr Duration kRetryAfter = std::chrono::milliseconds(250);
constexpr int kMostTries = 20;

// MAV_MISSION_RESULT.
namespace mission_result {
constexpr int kAccepted = 0, kError = 1, kUnsupportedFrame = 2, kUnsupported = 3, kNoSpace = 4,
              kInvalid = 5, kInvalidSequence = 13, kCancelled = 15;
}  // namespace mission_result

constexpr int kItems[] = {kWaypoint, kLoiterUnlimited, kLoiterTime, kReturnToLaunch,
                          kLandItem, kTakeoffItem,     kDelay,      kChangeSpeed};
// Those with latitude, longitude and altitude; a landing without any is at the place.
constexpr int kPlaces[] = {kWaypoint, kLoiterUnlimited, kLoiterTime, kLandItem, kTakeoffItem};
constexpr int kFrames[] = {0, 3, 5, 6};  // global, and relative to home's altitude

constexpr int kMissionType = 0, kAllTypes = 255;  // MAV_MISSION_TYPE

MissionItem item_of(const mavlink::Message& message) {
  MissionItem item;
  const bool as_integers = message.is("MISSION_ITEM_INT");
  item.frame = static_cast<int>(message.integer("frame"));
  item.command = static_cast<int>(message.integer("command"));
  item.goes_on = message.integer("autocontinue") != 0;
  for (std::size_t i = 0; i < 4; ++i)
    item.parameters[i] = message.number("param" + std::to_string(i + 1));
  item.latitude_deg = message.number("x") * (as_integers ? 1e-7 : 1.0);
  item.longitude_deg = message.number("y") * (as_integers ? 1e-7 : 1.0);
  item.z_m = message.number("z");
  return item;
}

// How long it is held or waits, and how fast; a time that is no number is none.
bool has_sound_parameters(const MissionItem& item) {
  constexpr double kMost_s = 86'400.0;
  const double first = item.parameters[0], speed_m_s = item.parameters[1];
  const bool is_timed =
      item.command == kWaypoint || item.command == kLoiterTime || item.command == kDelay;
  if (is_timed) return std::isnan(first) || std::abs(first - kMost_s / 2) <= kMost_s / 2;
  return item.command != kChangeSpeed || std::isfinite(speed_m_s);
}

int fault_of(const MissionItem& item) {
  if (std::ranges::find(kItems, item.command) == std::end(kItems))
    return mission_result::kUnsupported;
  if (!has_sound_parameters(item)) return mission_result::kInvalid;
  if (std::ranges::find(kPlaces, item.command) == std::end(kPlaces))
    return mission_result::kAccepted;
  if (std::ranges::find(kFrames, item.frame) == std::end(kFrames))
    return mission_result::kUnsupportedFrame;
  return is_place(item.latitude_deg, item.longitude_deg, item.z_m) ? mission_result::kAccepted
                                                                   : mission_result::kInvalid;
}

void acknowledge(mavlink::Address to, int result, Outbox& outbox, std::int64_t type = 0) {
  outbox.send(mavlink::Message("MISSION_ACK")
                  .set("target_system", to.system)
                  .set("target_component", to.component)
                  .set("type", result)
                  .set("mission_type", type));
}

}  // namespace

bool Missions::takes(const mavlink::Message& message) {
  return message.name().starts_with("MISSION_");
}

void Missions::on_message(const mavlink::Frame& frame, const Vehicle& vehicle, Outbox& outbox) {
  const mavlink::Message& m = frame.message;
  const auto type = m.type().field("mission_type") ? m.integer("mission_type") : kMissionType;
  if (type != kMissionType && !(type == kAllTypes && m.is("MISSION_CLEAR_ALL"))) {
    if (!m.is("MISSION_ACK")) acknowledge(frame.from, mission_result::kUnsupported, outbox, type);
    return;
  }
  if (m.is("MISSION_COUNT")) return begin_upload(frame, vehicle.now, outbox);
  if (m.is("MISSION_ITEM_INT") || m.is("MISSION_ITEM"))
    return take_item(frame, vehicle.now, outbox);
  if (m.is("MISSION_REQUEST_LIST"))
    return outbox.send(mavlink::Message("MISSION_COUNT")
                           .set("target_system", frame.from.system)
                           .set("target_component", frame.from.component)
                           .set("count", items_.size()));
  if (m.is("MISSION_REQUEST_INT")) return send_item(frame, true, outbox);
  if (m.is("MISSION_REQUEST")) return send_item(frame, false, outbox);
  if (m.is("MISSION_CLEAR_ALL")) {
    replace({});
    return acknowledge(frame.from, mission_result::kAccepted, outbox, type);
  }
  if (m.is("MISSION_SET_CURRENT")) {
    go_to(static_cast<std::size_t>(m.integer("seq")));
    return send_current(outbox);
  }
  if (m.is("MISSION_ACK") && upload_ && upload_->from == frame.from) upload_.reset();
}

void Missions::begin_upload(const mavlink::Frame& frame, SimTime now, Outbox& outbox) {
  const auto count = static_cast<std::size_t>(frame.message.integer("count"));
  if (count > kMostItems) return acknowledge(frame.from, mission_result::kNoSpace, outbox);
  if (upload_ && upload_->from != frame.from) {
    outbox.say(4, "mission refused: another one is being sent");
    return acknowledge(frame.from, mission_result::kError, outbox);
  }
  upload_ = {.from = frame.from, .count = count, .items = {}};
  if (count > 0) return ask(now, outbox);
  replace({});
  acknowledge(frame.from, mission_result::kAccepted, outbox);
}

void Missions::replace(std::vector<MissionItem> items) {
  items_ = std::move(items);
  ++plan_;
  current_ = 0;
  upload_.reset();
}

// An item that is not the one that was asked for is dropped, and the other one asked for again.
void Missions::take_item(const mavlink::Frame& frame, SimTime now, Outbox& outbox) {
  if (!upload_ || upload_->from != frame.from) return;
  const auto sequence = static_cast<std::size_t>(frame.message.integer("seq"));
  if (sequence != upload_->items.size()) return;
  const MissionItem item = item_of(frame.message);
  const int fault = fault_of(item);
  if (fault != mission_result::kAccepted) {
    upload_.reset();
    return acknowledge(frame.from, fault, outbox);
  }
  upload_->items.push_back(item);
  upload_->tries = 0;
  if (upload_->items.size() < upload_->count) return ask(now, outbox);
  replace(std::move(upload_->items));
  acknowledge(frame.from, mission_result::kAccepted, outbox);
}

void Missions::ask(SimTime now, Outbox& outbox) {
  upload_->asked_at = now;
  ++upload_->tries;
  outbox.send(mavlink::Message("MISSION_REQUEST_INT")
                  .set("target_system", upload_->from.system)
                  .set("target_component", upload_->from.component)
                  .set("seq", upload_->items.size()));
}

void Missions::step(SimTime now, Outbox& outbox) {
  if (!upload_ || now - upload_->asked_at < kRetryAfter) return;
  if (upload_->tries < kMostTries) return ask(now, outbox);
  acknowledge(upload_->from, mission_result::kCancelled, outbox);
  upload_.reset();
}

void Missions::send_item(const mavlink::Frame& request, bool as_integers, Outbox& outbox) const {
  const auto sequence = static_cast<std::size_t>(request.message.integer("seq"));
  if (sequence >= items_.size())
    return acknowledge(request.from, mission_result::kInvalidSequence, outbox);
  const MissionItem& item = items_[sequence];
  mavlink::Message m(as_integers ? "MISSION_ITEM_INT" : "MISSION_ITEM");
  m.set("target_system", request.from.system)
      .set("target_component", request.from.component)
      .set("seq", sequence)
      .set("frame", item.frame)
      .set("command", item.command)
      .set("current", sequence == current_ ? 1 : 0)
      .set("autocontinue", item.goes_on ? 1 : 0)
      .set("x", item.latitude_deg * (as_integers ? 1e7 : 1.0))
      .set("y", item.longitude_deg * (as_integers ? 1e7 : 1.0))
      .set("z", item.z_m);
  for (std::size_t i = 0; i < 4; ++i) m.set("param" + std::to_string(i + 1), item.parameters[i]);
  outbox.send(m);
}

void Missions::say_reached(Outbox& outbox) const {
  outbox.send(mavlink::Message("MISSION_ITEM_REACHED").set("seq", current_));
}

bool Missions::go_to(std::size_t item) {
  if (item >= items_.size()) return false;
  current_ = item;
  return true;
}

bool Missions::go_on(Outbox& outbox) {
  ++current_;
  if (is_at_end()) return false;
  send_current(outbox);
  return true;
}

void Missions::send_current(Outbox& outbox) const {
  outbox.send(mavlink::Message("MISSION_CURRENT").set("seq", shown()).set("total", items_.size()));
}

}  // namespace tether::autopilot
