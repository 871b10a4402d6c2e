#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <tether/sim_gazebo_plugin/session.h>
#include <tether/sim_protocol/connection.h>

namespace tether::gazebo_plugin {

/// How a conversation ended. `wrong` is empty when the host left between two requests.
struct End {
  std::string wrong;
};

/// The conversation with the one host that a world has. It is listened to on a thread of its own,
/// so that a host that leaves is noticed whatever the world is busy with.
class HostLine : public Host {
 public:
  /// `on_end` is called once, on that thread, unless the line is destroyed before.
  HostLine(std::unique_ptr<protocol::Listener> listener, std::function<void(const End&)> on_end);
  ~HostLine() override;

  std::optional<protocol::Request> next() override;
  /// A reply that `validate` refuses becomes a Failed that says why, and ends the conversation.
  void answer(const protocol::Reply& reply) override;
  /// From now on there is no `next`. Any thread, signal handlers too.
  void stop() { stopped_ = true; }
  bool is_stopped() const { return stopped_; }

 private:
  Status send(const protocol::Reply& reply);
  void lose_host();
  void listen();
  std::string converse(protocol::Connection& connection);

  std::unique_ptr<protocol::Listener> listener_;
  std::function<void(const End&)> on_end_;
  std::atomic<bool> stopped_{false};
  std::atomic<bool> closing_{false};

  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<protocol::Connection> connection_;  // shared: each thread uses it until its end
  std::optional<protocol::Request> request_;
  bool answered_ = true;
  std::string failure_;  // of which the host was told

  std::thread thread_;
};

}  // namespace tether::gazebo_plugin
