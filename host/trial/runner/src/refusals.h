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

  /// With `hold`, the line waits for the next one, or for close(): the refusal may be why the run
  /// ends.
  void add(const std::string& address, const std::string& reason, bool hold) {
    show_held();
    last_ = reason;
    if (++count_ <= kMostShown) held_ = fmt::format("refused {}: {}", address, reason);
    if (!hold) show_held();
  }
  /// The last reason, for an end that names it: its line is not shown. Empty if there is none.
  std::string take_last() {
    held_.clear();
    return last_;
  }
  /// Shows what is held, and the number of the other connections.
  void close() {
    show_held();
    if (count_ > kMostShown && show_)
      show_(fmt::format("refused {} more connections", count_ - kMostShown));
  }

 private:
  void show_held() {
    if (!held_.empty() && show_) show_(held_);
    held_.clear();
  }

  std::function<void(const std::string&)> show_;
  std::size_t count_ = 0;
  std::string last_;
  std::string held_;
};

}  // namespace tether::runner
