#include <chrono>
#include <utility>

#include <tether/sim_gazebo_plugin/session.h>

namespace tether::gazebo_plugin {
namespace {

// Interval at which a waiting thread checks for a stop: signal handlers cannot wake it.
constexpr std::chrono::milliseconds kLook{50};

}  // namespace

HostLine::HostLine(std::unique_ptr<protocol::Listener> listener,
                   std::function<void(const End&)> on_end)
    : listener_(std::move(listener)), on_end_(std::move(on_end)), thread_([this] { listen(); }) {}

HostLine::~HostLine() {
  stop();
  closing_ = true;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (listener_) listener_->close();
    if (connection_) connection_->close();
  }
  thread_.join();
}

void HostLine::listen() {
  Result<std::unique_ptr<protocol::Connection>> accepted = listener_->accept();
  std::string wrong;
  if (accepted) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      connection_ = std::move(*accepted);
      // The destructor may have run before there was this connection to close.
      if (closing_) connection_->close();
    }
    wrong = converse(*connection_);
  } else {
    wrong = accepted.failure().message;
  }
  stop();
  {
    // The process may end before this object does; the listener's file must be removed.
    const std::lock_guard<std::mutex> lock(mutex_);
    listener_.reset();
  }
  if (!closing_) on_end_({wrong});
}

std::string HostLine::converse(protocol::Connection& connection) {
  for (;;) {
    Result<protocol::Request> request = connection.receive_request();
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!failure_.empty()) return failure_;
    if (!request) {
      const bool left = request.failure().kind == Failure::Kind::kDisconnected;
      if (left && answered_) return {};
      return left ? "the host left while it was waiting for an answer" : request.failure().message;
    }
    if (!answered_) return "the host sent a request before the last answer";
    request_ = std::move(*request);
    answered_ = false;
    changed_.notify_all();
  }
}

std::optional<protocol::Request> HostLine::next() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopped_ && !request_) changed_.wait_for(lock, kLook);
  if (stopped_) return std::nullopt;
  return std::exchange(request_, std::nullopt);
}

void HostLine::answer(const protocol::Reply& reply) {
  const Status sent = send(reply);
  if (sent) return;
  if (sent.failure().kind == Failure::Kind::kInvalid) {
    // Unstable physics gives numbers that are not finite.
    const protocol::Failed failed{"Gazebo's answer is invalid: " + sent.failure().message};
    if (!send(failed)) lose_host();
    stop();
  } else {
    lose_host();
  }
}

Status HostLine::send(const protocol::Reply& reply) {
  std::shared_ptr<protocol::Connection> connection;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    answered_ = true;
    if (const auto* failed = std::get_if<protocol::Failed>(&reply)) failure_ = failed->message;
    connection = connection_;
  }
  if (!connection) return ok_status();
  return connection->send(reply);
}

// The other thread, which receives, ends the line.
void HostLine::lose_host() {
  stop();
  const std::lock_guard<std::mutex> lock(mutex_);
  answered_ = false;
  connection_->close();
}

}  // namespace tether::gazebo_plugin
