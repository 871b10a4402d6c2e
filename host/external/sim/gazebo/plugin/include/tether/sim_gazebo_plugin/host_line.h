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

/// How a conversation ended. `wrong` is empty if the host left between two requests.
struct End {
  std::string wrong;
};

/// The conversation with the only host of a world. A separate thread receives, so that a host that
/// leaves is noticed while the world is busy.
class HostLine : public Host {
 public:
  /// `on_end` is called once, on that thread, unless the line is destroyed before.
  HostLine(std::unique_ptr<protocol::Listener> listener, std::function<void(const End&)> on_end);
  ~HostLine() override;

  std::optional<protocol::Request> next() override;
  /// A reply that `validate` refuses becomes a Failed with the reason, and ends the conversation.
  void answer(const protocol::Reply& reply) override;
  /// From now on `next` returns none. Any thread, also signal handlers.
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
  std::string failure_;  // that was sent to the host

  std::thread thread_;
};

}  // namespace tether::gazebo_plugin
