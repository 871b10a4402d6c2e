#include "errors.h"
#include "handles.h"

#include <span>
#include <string_view>

using namespace tether::c_api;

extern "C" {

size_t tether_peer_count(const tether_vehicle* vehicle) noexcept {
  return are_given(vehicle) ? vehicle->vehicle->peers().size() : 0;
}

const char* tether_peer_at(const tether_vehicle* vehicle, size_t index) noexcept {
  if (!are_given(vehicle)) return nullptr;
  const auto& peers = vehicle->vehicle->peers();
  return index < peers.size() ? peers[index].c_str() : nullptr;
}

tether_status tether_send(tether_vehicle* vehicle, const char* to, const void* bytes,
                          size_t size) noexcept {
  if (!are_given(vehicle) || (size > 0 && !are_given(bytes))) return TETHER_INVALID;
  if (to != nullptr && *to == '\0')
    return fail(TETHER_INVALID,
                "the receiver is an empty text; pass the name of a UAV, or NULL for all others");
  return guarded([&] {
    return status_of(vehicle->vehicle->send(to != nullptr ? to : std::string_view(),
                                            {static_cast<const std::uint8_t*>(bytes), size}));
  });
}

tether_status tether_receive(tether_vehicle* vehicle, int64_t timeout_ns,
                             tether_message** out) noexcept {
  if (!are_given(out)) return TETHER_INVALID;
  *out = nullptr;
  if (!are_given(vehicle)) return TETHER_INVALID;
  return guarded([&] {
    auto message = vehicle->vehicle->receive(tether::Duration(timeout_ns));
    if (message) *out = new tether_message{std::move(*message)};
    return status_of(message);
  });
}

const char* tether_message_from(const tether_message* message) noexcept {
  return are_given(message) ? message->message.from.c_str() : "";
}

const uint8_t* tether_message_bytes(const tether_message* message, size_t* size) noexcept {
  if (size != nullptr) *size = 0;
  if (!are_given(message, size)) return nullptr;
  *size = message->message.bytes.size();
  return message->message.bytes.data();
}

int64_t tether_message_sent_at(const tether_message* message) noexcept {
  return are_given(message) ? tether::to_ns(message->message.sent_at) : 0;
}

int64_t tether_message_arrived_at(const tether_message* message) noexcept {
  return are_given(message) ? tether::to_ns(message->message.arrived_at) : 0;
}

void tether_message_free(tether_message* message) noexcept {
  delete message;
}

}  // extern "C"
