#pragma once

#include <string>

#include <tether/base/time.h>
#include <tether/uav/catalogue.h>

namespace tether::as_is {

/// What a receiver of satellite navigation says of a measurement: the sentences GGA, RMC and GST,
/// each with its line end (NMEA 0183, talker GN). 12 satellites and an HDOP of 1 stand for a fix;
/// the accuracies are in GST. Altitudes are above the ellipsoid, with a geoid separation of 0.
/// @param at_utc of the measurement, since 1970
std::string nmea_of(const uav::NavSatSample& sample, Duration at_utc);

}  // namespace tether::as_is
