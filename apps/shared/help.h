#pragma once

#include <cstddef>
#include <memory>

#include <CLI/CLI.hpp>

namespace tether::app {

/// How --help is laid out: names to the left, texts wrapped at `columns`. Of an option it also has
/// its choices, or the range of its number, and its default.
std::shared_ptr<CLI::FormatterBase> help_format(std::size_t columns);

}  // namespace tether::app
