#pragma once

#include "raw_client.h"
#include "recording_events.h"

#include <chrono>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include <tether/link/server.h>

namespace tether::link {

/// A server on a free port of this machine, with what it reported so far.
class ServerFixture : public testing::Test {
 protected:
  /// A new server, of which nothing has been reported.
  void listen(Duration hello_timeout = std::chrono::hours(1)) {
    events_ = {};
    server_ = listen_tcp({"127.0.0.1", 0}, hello_timeout);
  }
  RawClient connect() { return RawClient(server_->address()); }
  bool poll_until(const std::function<bool()>& done) {
    return link::poll_until(*server_, events_, done);
  }
  /// The server receives what the client sends now.
  void expect_served(RawClient& client) {
    const std::size_t before = events_.received.size();
    client.write(Progress{from_ns<ExecTime>(7)});
    ASSERT_TRUE(poll_until([&] { return events_.received.size() > before; }));
  }
  bool wait_for_closed() {
    return poll_until([&] { return !events_.closed.empty(); });
  }

  RecordingEvents events_;
  std::unique_ptr<Server> server_;
};

}  // namespace tether::link
