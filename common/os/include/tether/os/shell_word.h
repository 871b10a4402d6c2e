#pragma once

#include <string>

namespace tether::os {

/// The text quoted so that a shell reads it as one word.
std::string shell_word(const std::string& text);

}  // namespace tether::os
