#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace tether::record {

/// A record is damaged. This exception does not leave the library: the reader turns it into
/// `Record::damage`.
class Damage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  /// `kind` is "member" (of a JSON object) or "value" (of the metadata).
  Damage(const std::string& kind, std::string name, const std::string& what)
      : std::runtime_error(kind + " \"" + name + "\" " + what), name_(std::move(name)) {}

  /// The member or value that is missing or wrong; empty if the damage is elsewhere.
  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

}  // namespace tether::record
