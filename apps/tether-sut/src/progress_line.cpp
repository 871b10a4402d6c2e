#include "progress_line.h"

#include <iostream>

#include <unistd.h>

namespace tether::sut {
namespace {

constexpr std::chrono::seconds kBetweenLines(10);

}  // namespace

ProgressLine::ProgressLine()
    : is_terminal_(isatty(STDERR_FILENO) == 1), last_(std::chrono::steady_clock::now()) {}

ProgressLine::~ProgressLine() {
  if (is_shown_) std::cerr << "\r\x1b[K" << std::flush;
}

void ProgressLine::show(const std::string& what) {
  if (is_terminal_) {
    std::cerr << "\r\x1b[K" << what << std::flush;
    is_shown_ = true;
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ >= kBetweenLines) {
    std::cerr << what << '\n';
    last_ = now;
  }
}

}  // namespace tether::sut
