#pragma once

#include <string>

namespace tether::toml {

/// The shortest text that reads back as the same number: "25", "0.1", "1e-05", "nan".
std::string number_text(double number);

}  // namespace tether::toml
