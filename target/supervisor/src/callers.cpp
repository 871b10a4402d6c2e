#include "callers.h"

#include <algorithm>
#include <set>
#include <utility>

namespace tether::supervisor {

void Callers::add_to(std::vector<pollfd>& entries) const {
  entries.push_back({listener_.get(), POLLIN, 0});
  for (const auto& [id, socket] : connections_) entries.push_back({socket.descriptor(), POLLIN, 0});
}

void Callers::accept_all() {
  while (os::FileDescriptor accepted = client::accept_local(listener_)) {
    client::LocalSocket socket(std::move(accepted));
    if (socket.send_clock(clock_page_)) connections_.emplace(++last_, std::move(socket));
  }
}

void Callers::receive_all(const Events& events) {
  accept_all();
  receive_if(events, [](int) { return true; });
}

void Callers::receive(const std::vector<pollfd>& entries, const Events& events) {
  std::set<int> ready;
  for (const pollfd& entry : entries) {
    if (entry.revents != 0) ready.insert(entry.fd);
  }
  if (ready.count(listener_.get()) > 0) accept_all();
  receive_if(events, [&](int descriptor) { return ready.count(descriptor) > 0; });
}

// The events may drop callers, the present one too.
template <class Wanted>
void Callers::receive_if(const Events& events, Wanted wanted) {
  std::vector<CallerId> ids;
  for (const auto& [id, socket] : connections_) {
    if (wanted(socket.descriptor())) ids.push_back(id);
  }
  for (const CallerId id : ids) {
    const auto found = connections_.find(id);
    if (found == connections_.end() || drain(id, found->second, events)) continue;
    connections_.erase(id);
    events.on_gone(id);
  }
}

/// False: the caller has gone, or talks nonsense.
bool Callers::drain(CallerId caller, client::LocalSocket& socket, const Events& events) {
  while (true) {
    auto packet = socket.receive();
    if (!packet) return packet.failure().kind == Failure::Kind::kTimeout;
    if (!packet->message) return false;
    events.on_message(caller, std::move(*packet->message));
    if (connections_.count(caller) == 0) return true;  // dropped, with its socket
  }
}

bool Callers::send(CallerId caller, const link::Message& message) {
  const auto found = connections_.find(caller);
  if (found == connections_.end()) return false;
  if (found->second.send(message)) return true;
  connections_.erase(found);
  return false;
}

}  // namespace tether::supervisor
