#pragma once

#include "scripted_threads.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <tether/base/error.h>
#include <tether/link/server.h>
#include <tether/record/writer.h>

namespace tether::coordinator {

/// A server whose peers are scripts. Everything happens in `poll` in a fixed order, without
/// threads, sockets and clocks.
class ScriptedServer final : public link::Server {
 public:
  using Script = coordinator::Script;

  /// Adds a peer that sends `hello` and then follows its script; returns its id.
  link::PeerId add_sut(link::Hello hello, Script script) {
    const link::PeerId peer = ++last_peer_;
    suts_[peer] = {std::move(script), 0, ExecTime{}, 0};
    deliver(peer, std::move(hello));
    return peer;
  }
  /// Adds a peer of several threads, one per script.
  link::PeerId add_threads(link::Hello hello, std::vector<Script> scripts,
                           Duration overshoot = Duration(0)) {
    const link::PeerId peer = ++last_peer_;
    hello.concurrent = true;
    threads_.emplace(peer, ScriptedThreads(std::move(scripts), overshoot,
                                           [this, peer](link::Message m) { deliver(peer, m); }));
    deliver(peer, std::move(hello));
    return peer;
  }
  /// A message of `peer` at the next poll.
  void deliver(link::PeerId peer, link::Message message) {
    queue_.push_back({peer, std::move(message)});
  }
  void disconnect(link::PeerId peer) {
    queue_.push_back({peer, link::Closed{{Failure::Kind::kDisconnected, "connection closed"}}});
  }
  /// The peer closes only its sending side.
  void half_close(link::PeerId peer) {
    disconnect(peer);
    std::get<link::Closed>(queue_.back().what).may_still_read = true;
  }

  /// The place of the peer's first waiting message; 0: it has none.
  std::size_t first_of(link::PeerId peer) const {
    const auto found = std::ranges::find(queue_, peer, &link::Event::peer);
    return found == queue_.end() ? 0 : static_cast<std::size_t>(found - queue_.begin());
  }

  link::Address address() const override { return {"script", 0}; }
  std::span<link::Event> poll(Duration) override {
    ++polls;
    if (queue_.empty()) return {};
    const link::PeerId peer = queue_[choose(queue_.size())].peer;
    const auto first = std::ranges::find(queue_, peer, &link::Event::peer);
    event_ = std::move(*first);
    queue_.erase(first);
    return {&event_, 1};
  }
  void send(link::PeerId peer, link::Message message) override {
    sent[peer].push_back(message);
    if (const auto threads = threads_.find(peer); threads != threads_.end())
      return threads->second.on_message(message);
    if (const auto* welcome = std::get_if<link::Welcome>(&message)) proceed(peer, welcome->start);
    if (const auto* reply = std::get_if<link::Reply>(&message)) proceed(peer, reply->resume_at);
  }
  std::uint64_t moved_bytes(link::PeerId) override { return moved ? moved() : 0; }
  void close(link::PeerId peer) override { closed.push_back(peer); }

  std::map<link::PeerId, std::vector<link::Message>> sent;
  std::vector<link::PeerId> closed;
  std::uint64_t polls = 0;
  /// Which of so many waiting messages; its peer's first one is next.
  std::function<std::size_t(std::size_t)> choose = [](std::size_t) { return 0; };
  std::function<std::uint64_t()> moved;

 private:
  struct Sut {
    Script script;
    std::size_t next = 0;
    ExecTime et;
    std::uint64_t sequence = 0;
  };

  void proceed(link::PeerId peer, ExecTime resume_at) {
    Sut& sut = suts_[peer];
    sut.et = resume_at;
    if (sut.next == sut.script.size()) return;
    const Act& act = sut.script[sut.next++];
    sut.et += act.compute;
    deliver(peer, make_request(act, ++sut.sequence, sut.et));
  }

  link::PeerId last_peer_ = 0;
  std::map<link::PeerId, Sut> suts_;
  std::map<link::PeerId, ScriptedThreads> threads_;
  std::deque<link::Event> queue_;
  link::Event event_;  // of the last poll
};

/// Keeps everything, for assertions.
class MemoryRecorder final : public record::Recorder {
 public:
  void write(const record::Header& m) override { keep(header, m); }
  void write(SimTime at, const record::Message& message) override {
    take_room();
    std::visit([&](const auto& m) { add(at, m); }, message);
  }
  void flush() override {}
  void write(const record::Footer& m) override { keep(footer, m); }

  int room = std::numeric_limits<int>::max();  // for so many messages

  record::Header header;
  std::vector<record::Interaction> interactions;
  std::vector<record::CommandEffect> commands;
  std::vector<record::GroundTruth> ground_truth;
  std::vector<record::Annotation> annotations;
  std::vector<record::Stop> stops;
  std::vector<std::pair<SimTime, record::Contact>> contacts;
  std::vector<record::Battery> batteries;
  std::vector<record::RadioMessage> radio;
  std::vector<record::AutopilotMessage> autopilot;
  std::vector<record::Image> images;
  std::vector<record::RawImage> raw_images;
  std::optional<record::Footer> footer;

 private:
  void take_room() {
    if (room == 0) throw Error(ErrorCode::kSetup, "the disk is full");
    --room;
  }
  template <class Place, class Message>
  void keep(Place& place, const Message& message) {
    take_room();
    place = message;
  }
  void add(SimTime, const record::Interaction& m) { interactions.push_back(m); }
  void add(SimTime, const record::CommandEffect& m) { commands.push_back(m); }
  void add(SimTime, const record::GroundTruth& m) { ground_truth.push_back(m); }
  void add(SimTime, const record::Annotation& m) { annotations.push_back(m); }
  void add(SimTime, const record::Stop& m) { stops.push_back(m); }
  void add(SimTime, const record::Battery& m) { batteries.push_back(m); }
  void add(SimTime, const record::RadioMessage& m) { radio.push_back(m); }
  void add(SimTime, const record::AutopilotMessage& m) { autopilot.push_back(m); }
  void add(SimTime, const record::Image& m) { images.push_back(m); }
  void add(SimTime, const record::RawImage& m) { raw_images.push_back(m); }
  void add(SimTime at, const record::Contact& m) { contacts.emplace_back(at, m); }
};

}  // namespace tether::coordinator
