#pragma once

#include "supervision.h"

#include <functional>
#include <map>
#include <string>
#include <vector>

#include <poll.h>

#include <tether/client/exec/local_socket.h>

namespace tether::supervisor {

/// The connections of the program's threads and processes.
class Callers {
 public:
  /// `clock_page` must outlive it.
  Callers(os::FileDescriptor listener, const os::FileDescriptor& clock_page)
      : listener_(std::move(listener)), clock_page_(clock_page) {}

  struct Events {
    std::function<void(CallerId, link::Message)> on_message;
    std::function<void(CallerId)> on_gone;
  };

  /// Adds the descriptors to poll.
  void add_to(std::vector<pollfd>& entries) const;
  /// Receives all messages that have arrived.
  void receive_all(const Events& events);
  /// Receives from new connections, and from those that are readable according to `entries`.
  void receive(const std::vector<pollfd>& entries, const Events& events);

  /// False: the caller has gone; `on_gone` is not called.
  bool send(CallerId caller, const link::Message& message);
  /// Hangs up; `on_gone` is not called.
  void drop(CallerId caller) { connections_.erase(caller); }

 private:
  void accept_all();
  bool drain(CallerId caller, client::LocalSocket& socket, const Events& events);
  template <class Wanted>
  void receive_if(const Events& events, Wanted wanted);

  os::FileDescriptor listener_;
  const os::FileDescriptor& clock_page_;
  CallerId last_ = 0;
  std::map<CallerId, client::LocalSocket> connections_;
};

}  // namespace tether::supervisor
