#pragma once

#include <cstddef>
#include <cstdint>

namespace tether::fuzz {

/// Changes the content of one record of an MCAP file, and its length with it, so that what comes
/// behind can still be read; sometimes any bytes. Returns the new size, at most `max_size`.
std::size_t mutate_mcap(std::uint8_t* data, std::size_t size, std::size_t max_size,
                        unsigned int seed);

}  // namespace tether::fuzz
