#pragma once

#include <memory>
#include <string>
#include <utility>
#include <variant>

#include <tether/base/error.h>
#include <tether/sim_protocol/connection.h>
#include <tether/sim_remote/remote_simulator.h>

namespace tether::sim {

/// The host's end of a connection to a simulator, with patience: sends a request and waits for its
/// answer. One thread at a time. Once it has thrown, there is no way on.
class RemoteSession {
 public:
  RemoteSession(std::unique_ptr<protocol::Connection> connection, RemoteOptions options);
  ~RemoteSession();
  RemoteSession(const RemoteSession&) = delete;
  RemoteSession& operator=(const RemoteSession&) = delete;

  /// What the simulator calls itself, for messages.
  void call_it(std::string name) { name_ = " " + std::move(name); }
  std::string name() const { return "the simulator" + name_; }

  /// @throws Error(kSetup) naming the simulator and what it did, where it gave no answer.
  protocol::Opened open(const protocol::Open& request);
  protocol::State ask(const protocol::Reset& request) { return ask<protocol::State>(request); }
  protocol::State ask(const protocol::Advance& request) { return ask<protocol::State>(request); }
  protocol::Distances ask(const protocol::CastRays& request) {
    return ask<protocol::Distances>(request);
  }
  protocol::Picture ask(const protocol::Render& request) { return ask<protocol::Picture>(request); }

 private:
  template <class Expected>
  Expected ask(const protocol::Request& request) {
    return take<Expected>(answer_to(request, options_.answer_limit));
  }
  template <class Expected>
  Expected take(protocol::Reply reply) {
    if (auto* expected = std::get_if<Expected>(&reply)) return std::move(*expected);
    throw Error(ErrorCode::kSetup, name() + " gave an answer to something else");
  }

  protocol::Reply answer_to(const protocol::Request& request, Duration limit);
  Result<protocol::Reply> await(Duration limit);
  void give_up_if_told();
  [[noreturn]] void throw_lost(const Failure& failure, Duration limit);

  std::unique_ptr<protocol::Connection> connection_;
  RemoteOptions options_;
  std::string name_;
};

}  // namespace tether::sim
