#include "peers.h"

#include <iterator>
#include <utility>

namespace tether::fuzz {

using link::Message;

std::span<link::Event> Peers::poll(Duration) {
  event_.reset();
  if (const auto came = std::exchange(came_, std::nullopt)) {
    if (peers_.contains(*came)) event_ = {*came, Message(hello())};
  } else if (finished() && peers_.empty()) {
    passed += std::chrono::hours(1);
  } else {
    go_on();
  }
  if (!event_) return {};
  return {&*event_, 1};
}

void Peers::go_on() {
  const std::size_t choice = choices_.below(16);
  if (finished() || (choice == 0 && !peers_.empty())) {
    leave(peers_.empty() ? 0 : peers_.begin()->first);
  } else if (choice == 1 || peers_.empty()) {
    come();
  } else if (choice == 2) {
    passed += std::chrono::milliseconds(choices_.byte() * 64);
  } else {
    const auto peer = std::next(peers_.begin(), static_cast<long>(choices_.below(peers_.size())));
    speak(peer->first, peer->second);
  }
}

void Peers::come() {
  peers_[++last_id_] = {};
  came_ = last_id_;
  event_ = {last_id_, link::Connected{"peer " + std::to_string(last_id_)}};
}

void Peers::leave(link::PeerId id) {
  if (peers_.erase(id) == 1) event_ = {id, link::Closed{{Failure::Kind::kDisconnected, "hung up"}}};
}

void Peers::speak(link::PeerId id, Peer& peer) {
  Message said = message(peer);
  if (link::validate(said).ok()) event_ = {id, std::move(said)};
}

link::Hello Peers::hello() {
  link::Hello hello;
  const std::uint8_t flags = choices_.byte();
  hello.sut = choices_.text();
  hello.token = flags % 16 == 15 ? choices_.text() : "secret";
  hello.uav = "uav" + std::to_string(flags / 16 % 4);
  hello.clock.kind = static_cast<computer::ClockKind>(choices_.below(6));
  hello.concurrent = choices_.coin();
  return hello;
}

/// Mostly as an honest SUT would have it: a little after `from`.
ExecTime Peers::stamp(ExecTime from) {
  const std::uint8_t kind = choices_.byte();
  if (kind < 192) {
    const std::chrono::microseconds computed(kind * 16);
    passed += computed;
    return from + computed;
  }
  const std::int64_t far = choices_.number();
  return kind < 224 ? from_ns<ExecTime>(far) : from + Duration(far >> 16);
}

Message Peers::message(Peer& peer) {
  switch (choices_.below(8)) {
    case 0:
      return link::Progress{peer.et = stamp(peer.et), choices_.coin()};
    case 1:
      return link::Annotation{stamp(peer.et), "roi", "{" + choices_.text() + "}"};
    case 2:
      if (choices_.below(16) == 0) return hello();
      if (choices_.below(16) == 0) return link::Due{1, peer.et};
      return link::Progress{peer.et, true};
    default:
      return request(peer);
  }
}

link::Request Peers::request(Peer& peer) {
  link::Request request;
  const std::uint8_t flags = choices_.byte();
  request.sequence = flags == 255 ? choices_.word() : ++peer.sequence;
  request.issued_at = peer.et = stamp(peer.et);
  request.previous_round_trip = Duration(choices_.byte());
  switch (flags % 8) {
    case 0:
      request.body = link::SetVelocity{{{1.0, 0.0, choices_.byte() / 64.0}, 0.5}};
      break;
    case 1:
      request.body = link::Sleep{stamp(peer.et)};
      break;
    case 2:
      if (choices_.below(4) == 0) {
        request.body = link::Finish{choices_.coin(), "done" + choices_.text(), "{}"};
        break;
      }
      [[fallthrough]];
    case 3: {
      link::SetTrajectory set;
      for (std::size_t i = choices_.below(4); i > 0; --i) {
        set.setpoints.push_back({Duration(choices_.byte()), {}});
        set.setpoints.back().setpoint.mask = choices_.byte();
        set.setpoints.back().setpoint.in_heading = choices_.coin();
      }
      request.body = std::move(set);
      break;
    }
    default:
      request.body = link::ReadSensor{static_cast<std::uint32_t>(choices_.below(4)),
                                      choices_.coin(), flags % 8 == 7};
  }
  return request;
}

void Peers::send(link::PeerId id, Message message) {
  require(link::validate(message).ok(), "the coordinator sends what it must not");
  const auto found = peers_.find(id);
  if (found == peers_.end()) return;
  if (const auto* reply = std::get_if<link::Reply>(&message)) {
    require(reply->sequence <= found->second.sequence || found->second.sequence == 0,
            "a reply to nothing");
    found->second.et = std::max(found->second.et, reply->resume_at);
  }
}

}  // namespace tether::fuzz
