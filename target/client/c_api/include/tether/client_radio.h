#pragma once

#include <tether/client.h>

/// @cond
#ifdef __cplusplus
extern "C" {
#endif
/// @endcond

/// @defgroup c_radio Radio
/// @ingroup c_api
/// Messages between the programs of the UAVs. The scenario's radio determines whether and when a
/// message arrives. Messages arrive in the order of time; those of one instant in the order of UAVs
/// in the scenario, and those of one UAV in the order in which it sent them.
/// @{

/// Number of the other UAVs. @param vehicle  the UAV  @return the number; 0 if `vehicle` is NULL
size_t tether_peer_count(const tether_vehicle* vehicle) TETHER_NOEXCEPT;
/// Another UAV by its index.
/// @param vehicle  the UAV  @param index  from 0
/// @return its name, owned by the vehicle; NULL if `index` is not below tether_peer_count()
const char* tether_peer_at(const tether_vehicle* vehicle, size_t index) TETHER_NOEXCEPT;

/// Sends a message. An @ref interaction that returns at the same ET.
/// @param vehicle  the UAV  @param to  name of another UAV, or NULL: all others
/// @param bytes  the message; may be NULL if `size` is 0  @param size  0 to 65536 [bytes]
/// @return TETHER_OK, also if it will be lost, or an @ref interaction error; TETHER_INVALID if `to`
///   is empty, if there is no such UAV or no other one, or if the message is too long. Then nothing
///   is sent
tether_status tether_send(tether_vehicle* vehicle, const char* to, const void* bytes,
                          size_t size) TETHER_NOEXCEPT;

/// A message that was received. It belongs to no vehicle, may outlive it, and never changes.
typedef struct tether_message tether_message;

/// Receives the next message that has arrived, or waits for one. An @ref interaction.
/// @param vehicle  the UAV  @param timeout_ns  of ET [ns]; not above 0: does not wait
/// @param[out] out  the message; free it with tether_message_free()
/// @return TETHER_OK, TETHER_NOTHING_YET if none has arrived by the timeout, or an @ref interaction
///   error
tether_status tether_receive(tether_vehicle* vehicle, int64_t timeout_ns,
                             tether_message** out) TETHER_NOEXCEPT;
/// Its sender. @param message  the message  @return name of a UAV; "" only if `message` is NULL
const char* tether_message_from(const tether_message* message) TETHER_NOEXCEPT;
/// Its contents. @param message  the message  @param[out] size  their number
/// @return the bytes, owned by the message; NULL if an argument is NULL
const uint8_t* tether_message_bytes(const tether_message* message, size_t* size) TETHER_NOEXCEPT;
/// When it was sent. @param message  the message  @return the sender's ET [ns]; 0 if NULL
int64_t tether_message_sent_at(const tether_message* message) TETHER_NOEXCEPT;
/// When it arrived. @param message  the message  @return ST [ns], not before it was sent; 0 if NULL
int64_t tether_message_arrived_at(const tether_message* message) TETHER_NOEXCEPT;
/// Frees a message. @param message  the message, or NULL
void tether_message_free(tether_message* message) TETHER_NOEXCEPT;

/// @}

#ifdef __cplusplus
}
#endif
