#pragma once

#include "options/common_options.h"

#include <string>

#include <tether/campaign/campaign_plan.h>
#include <tether/scenario/campaign.h>

/// What commands that run trials have in common.
namespace tether::app {

/// Each parallel trial with Gazebo needs a port.
/// @throws Error(kUsage) about GAZEBO_MASTER_URI if that selects one.
void require_ports(const scenario::Campaign& campaign, int jobs);

/// Versions and options that must be equal for results to be comparable.
/// With the machine, if measured times depend on it.
campaign::Settings versions_of(const scenario::Campaign& campaign, const ReadingOptions& reading,
                               bool by_engine);

}  // namespace tether::app
