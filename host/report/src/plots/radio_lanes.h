#pragma once

#include <string>

#include <tether/record/reader.h>

namespace tether::report {

/// A drawing (inline SVG) of the links between UAVs: a lane for each link over ST, with columns of
/// messages that arrived (upwards) and that were lost (downwards), and its delivery ratio and
/// median delay. Of many links, those that lost most. Empty if nothing was sent.
std::string radio_lanes(const record::Record& record);

}  // namespace tether::report
