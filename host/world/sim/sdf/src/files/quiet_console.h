#pragma once

#include <iostream>
#include <streambuf>
#include <string>

#include <console_bridge/console.h>
#include <sdf/sdf.hh>

namespace tether::sim {

/// Discards what libsdformat and the URDF reader that it tries on broken files write to the
/// console while this lives; keeps the first complaint of the latter.
class QuietConsole {
 public:
  QuietConsole()
      : messages_(sdf::Console::Instance()->GetMsgStream().GetStream()),
        errors_(std::cerr.rdbuf(&nothing_)) {
    sdf::Console::Instance()->GetMsgStream().SetStream(nullptr);
    console_bridge::useOutputHandler(&of_urdf_);
  }
  ~QuietConsole() {
    sdf::Console::Instance()->GetMsgStream().SetStream(messages_);
    console_bridge::restorePreviousOutputHandler();
    std::cerr.rdbuf(errors_);
    std::cerr.clear();
  }
  QuietConsole(const QuietConsole&) = delete;
  QuietConsole& operator=(const QuietConsole&) = delete;

  const std::string& complaint() const { return of_urdf_.first; }

 private:
  struct Nothing : std::streambuf {
    int overflow(int c) override { return c; }
  };
  struct First : console_bridge::OutputHandler {
    void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
      if (first.empty() && level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) first = text;
    }
    std::string first;
  };
  std::ostream* messages_;
  Nothing nothing_;
  First of_urdf_;
  std::streambuf* errors_;
};

}  // namespace tether::sim
