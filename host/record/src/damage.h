#pragma once

#include <stdexcept>

namespace tether::record {

/// Something in a record is not as it must be. Stays inside the library: a reader turns it into
/// `Record::damage`.
class Damage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace tether::record
