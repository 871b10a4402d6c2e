#pragma once

#include <cstdint>
#include <vector>

#include <tether/base/random.h>

/// For tests of readers with corrupt input.
namespace tether {

/// Changes one to four bytes: a bit, all ones, all zeros, or anything. @pre not empty.
void damage(std::vector<std::uint8_t>& bytes, KeyedRandom& random);

}  // namespace tether
