#pragma once

#include <string>
#include <utility>
#include <variant>

#include <tether/base/text.h>

namespace tether {

/// Why a call that does not throw failed. Used on the SUT's side of the link (`client`, `link`), so
/// that users' programs need not handle our exceptions; host code turns it into an `Error`.
struct Failure {
  enum class Kind {
    kRefused,       ///< the coordinator refused (wrong name, token, version, argument)
    kDisconnected,  ///< the connection ended
    kProtocol,      ///< the peer violated the protocol
    kTimeout,       ///< no answer within the limit
    kRunEnded,      ///< the coordinator ended the run
    kInvalid,       ///< the caller's argument cannot be used
    kNothingYet,    ///< a read that does not wait found no sample; not an error
  };
  Failure() = default;
  Failure(Kind what_kind, const std::string& why) : kind(what_kind), message(printable(why)) {}

  Kind kind = Kind::kInvalid;
  std::string message;  ///< one printable line for the user
};

/// The failure of a call whose argument, file or device cannot be used.
inline Failure invalid(const std::string& why) {
  return {Failure::Kind::kInvalid, why};
}

/// A value or a failure. `T` must not be `Failure`.
template <class T>
class [[nodiscard]] Result {
 public:
  // Implicit by design: `return value;` and `return Failure{…};` read as what they mean.
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}            // NOLINT
  Result(Failure failure) : state_(std::in_place_index<1>, std::move(failure)) {}  // NOLINT

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }
  /// @pre ok()
  T& value() & { return *std::get_if<0>(&state_); }
  const T& value() const& { return *std::get_if<0>(&state_); }
  T&& value() && { return std::move(*std::get_if<0>(&state_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T* operator->() { return std::get_if<0>(&state_); }
  const T* operator->() const { return std::get_if<0>(&state_); }
  /// @pre !ok()
  const Failure& failure() const { return *std::get_if<1>(&state_); }

 private:
  std::variant<T, Failure> state_;
};

/// Success without a value, or a failure.
using Status = Result<std::monostate>;
inline Status ok_status() {
  return Status(std::monostate{});
}

}  // namespace tether
