#pragma once

#include <string>

namespace tether::os {

/// As a shell takes it for one word and nothing more.
std::string shell_word(const std::string& text);

}  // namespace tether::os
