#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace tether::runner {

/// Connections that a run did not let in. Whoever wants to fill a terminal, or the disk that its
/// output goes to, could make a thousand a second.
class Refusals {
 public:
  static constexpr std::size_t kMostShown = 20;

  /// `show` gets a line for each of the first ones; it may be empty.
  explicit Refusals(std::function<void(const std::string&)> show) : show_(std::move(show)) {}

  void add(const std::string& text) {
    last_ = text;
    if (++count_ <= kMostShown && show_) show_(text);
  }
  /// Shows how many others there were.
  void close() const {
    if (count_ > kMostShown && show_)
      show_(fmt::format("refused {} more connections", count_ - kMostShown));
  }
  /// Empty: none so far.
  const std::string& last() const { return last_; }

 private:
  std::function<void(const std::string&)> show_;
  std::size_t count_ = 0;
  std::string last_;
};

}  // namespace tether::runner
