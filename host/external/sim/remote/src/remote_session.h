#pragma once

#include <memory>
#include <string>
#include <utility>
#include <variant>

#include <tether/base/error.h>
#include <tether/sim_protocol/connection.h>
#include <tether/sim_remote/remote_simulator.h>

namespace tether::sim {

/// The host's end of a connection to a simulator: sends a request and waits for its answer, with a
/// time limit. One thread at a time. Once it has thrown, it must not be used again.
class RemoteSession {
 public:
  RemoteSession(std::unique_ptr<protocol::Connection> connection, RemoteOptions options);
  ~RemoteSession();
  RemoteSession(const RemoteSession&) = delete;
  RemoteSession& operator=(const RemoteSession&) = delete;

  /// The simulator's name for itself, for messages.
  void set_name(const std::string& name) { name_ = "the simulator " + name; }
  /// How messages begin.
  const std::string& name() const { return name_; }

  /// @throws Error(kSetup) about `name()` if there is no valid answer, Error(kBadFile) if the
  /// request cannot be sent.
  protocol::Opened open(const protocol::Open& request);
  template <class Expected>
  Expected ask(const protocol::Request& request) {
    return take<Expected>(answer_to(request, options_.answer_limit));
  }

 private:
  template <class Expected>
  Expected take(protocol::Reply reply) {
    if (auto* expected = std::get_if<Expected>(&reply)) return std::move(*expected);
    fail("replied to another request");
  }

  protocol::Reply answer_to(const protocol::Request& request, Duration limit);
  Result<protocol::Reply> await(Duration limit);
  void check_give_up();
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void throw_lost(const Failure& failure, Duration limit);

  std::unique_ptr<protocol::Connection> connection_;
  RemoteOptions options_;
  std::string name_;
};

}  // namespace tether::sim
