#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace tether::runner {

/// The connections that a run has rejected. Limits the lines about them: a client could make a
/// thousand connections a second to fill a terminal or a disk.
class Refusals {
 public:
  static constexpr std::size_t kMostShown = 20;

  /// `show` gets a line for each of the first connections; it may be empty.
  explicit Refusals(std::function<void(const std::string&)> show) : show_(std::move(show)) {}

  void add(const std::string& address, const std::string& reason) {
    last_ = reason;
    if (++count_ <= kMostShown && show_) show_(fmt::format("refused {}: {}", address, reason));
  }
  /// Shows the number of the other connections.
  void close() const {
    if (count_ > kMostShown && show_)
      show_(fmt::format("refused {} more connections", count_ - kMostShown));
  }
  /// The last reason; empty if there is none.
  const std::string& last() const { return last_; }

 private:
  std::function<void(const std::string&)> show_;
  std::size_t count_ = 0;
  std::string last_;
};

}  // namespace tether::runner
