#include "missions.h"

#include <algorithm>
#include <cmath>

namespace tether::autopilot {
namespace {

constexpr std::size_t kMostItems = 1000;
constexpr Duration kRetryAfter = std::chrono::milliseconds(250);
constexpr int kMostTries = 20;

// MAV_MISSION_RESULT.
namespace mission_result {
constexpr int kAccepted = 0, kUnsupportedFrame = 2, kUnsupported = 3, kNoSpace = 4, kInvalid = 5,
              kInvalidSequence = 13, kCancelled = 15;
}  // namespace mission_result

constexpr int kItems[] = {kWaypoint, kLoiterUnlimited, kLoiterTime, kReturnToLaunch,
                          kLandItem, kTakeoffItem,     kDelay,      kChangeSpeed};
// Those with latitude, longitude and altitude; a landing without any is at the place.
constexpr int kPlaces[] = {kWaypoint, kLoiterUnlimited, kLoiterTime, kLandItem, kTakeoffItem};
constexpr int kFrames[] = {0, 3, 5, 6};  // global, and relative to home's altitude

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

int fault_of(const MissionItem& item) {
  if (std::ranges::find(kItems, item.command) == std::end(kItems))
    return mission_result::kUnsupported;
  if (std::ranges::find(kPlaces, item.command) == std::end(kPlaces))
    return mission_result::kAccepted;
  if (std::ranges::find(kFrames, item.frame) == std::end(kFrames))
    return mission_result::kUnsupportedFrame;
  const bool is_place = std::abs(item.latitude_deg) <= 90.0 &&
                        std::abs(item.longitude_deg) <= 180.0 && std::isfinite(item.z_m);
  return is_place ? mission_result::kAccepted : mission_result::kInvalid;
}

}  // namespace

bool Missions::takes(const mavlink::Message& message) {
  return message.name().starts_with("MISSION_");
}

void Missions::on_message(const mavlink::Frame& frame, const Vehicle& vehicle, Outbox& outbox) {
  const mavlink::Message& m = frame.message;
  const auto* type = m.type().field("mission_type");
  if (type != nullptr && m.integer("mission_type") != 0) {
    if (!m.is("MISSION_ACK")) acknowledge(frame.from, mission_result::kUnsupported, outbox);
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
    const bool is_flown = vehicle.mode == Mode::kMission && vehicle.is_armed;
    if (!is_flown) {
      items_.clear();
      current_ = 0;
    }
    return acknowledge(frame.from,
                       is_flown ? mission_result::kCancelled : mission_result::kAccepted, outbox);
  }
  if (m.is("MISSION_SET_CURRENT")) {
    const auto wanted = static_cast<std::size_t>(m.integer("seq"));
    if (wanted < items_.size()) current_ = wanted;
    return send_current(outbox);
  }
  if (m.is("MISSION_ACK") && upload_ && upload_->from.system == frame.from.system) upload_.reset();
}

void Missions::begin_upload(const mavlink::Frame& frame, SimTime now, Outbox& outbox) {
  const auto count = static_cast<std::size_t>(frame.message.integer("count"));
  if (count > kMostItems) return acknowledge(frame.from, mission_result::kNoSpace, outbox);
  upload_ = {.from = frame.from, .count = count, .items = {}};
  if (count > 0) return ask(now, outbox);
  upload_.reset();
  items_.clear();
  current_ = 0;
  acknowledge(frame.from, mission_result::kAccepted, outbox);
}

// An item that was asked for twice may come twice.
void Missions::take_item(const mavlink::Frame& frame, SimTime now, Outbox& outbox) {
  if (!upload_) return;
  const auto sequence = static_cast<std::size_t>(frame.message.integer("seq"));
  if (sequence < upload_->items.size()) return;
  const MissionItem item = item_of(frame.message);
  const int fault =
      sequence == upload_->items.size() ? fault_of(item) : mission_result::kInvalidSequence;
  if (fault != mission_result::kAccepted) {
    upload_.reset();
    return acknowledge(frame.from, fault, outbox);
  }
  upload_->items.push_back(item);
  upload_->tries = 0;
  if (upload_->items.size() < upload_->count) return ask(now, outbox);
  items_ = std::move(upload_->items);
  current_ = 0;
  upload_.reset();
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

void Missions::acknowledge(mavlink::Address to, int result, Outbox& outbox) const {
  outbox.send(mavlink::Message("MISSION_ACK")
                  .set("target_system", to.system)
                  .set("target_component", to.component)
                  .set("type", result));
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

bool Missions::reached(Outbox& outbox) {
  outbox.send(mavlink::Message("MISSION_ITEM_REACHED").set("seq", current_));
  ++current_;
  if (is_at_end()) return false;
  send_current(outbox);
  return true;
}

void Missions::send_current(Outbox& outbox) const {
  outbox.send(mavlink::Message("MISSION_CURRENT").set("seq", std::min(current_, items_.size())));
}

}  // namespace tether::autopilot
