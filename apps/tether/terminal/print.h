#pragma once

#include <string>

#include <tether/report/verdict.h>

namespace tether::app {

/// Writes a text for people to stdout, wrapped by words at the terminal's width.
/// @throws std::system_error if it cannot be written.
void print(const std::string& text);

/// How answers are marked on stdout: in colours on a terminal.
report::Markup markup_of_stdout();

/// Writes a line to stderr, wrapped if it is a terminal: others search in logs for whole lines.
void complain(const std::string& line);

}  // namespace tether::app
