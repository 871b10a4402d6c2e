#pragma once

#include <string_view>

namespace tether::report {

/// The page's CSS, except the inks of its plots.
extern const std::string_view kPageStyle;

}  // namespace tether::report
