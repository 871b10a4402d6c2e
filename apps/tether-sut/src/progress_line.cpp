#include "progress_line.h"

#include <iostream>

#include <unistd.h>

#include <tether/os/terminal.h>

namespace tether::sut {
namespace {

constexpr std::chrono::seconds kBetweenLines(10);

}  // namespace

ProgressLine::ProgressLine() : last_(std::chrono::steady_clock::now()) {}

ProgressLine::~ProgressLine() {
  if (is_shown_) std::cerr << os::kClearLine << std::flush;
}

void ProgressLine::show(const std::string& what) {
  if (const int columns = os::terminal_columns(STDERR_FILENO)) {
    std::cerr << os::kClearLine << os::cut_to_columns(what, columns) << std::flush;
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
