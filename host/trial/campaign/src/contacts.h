#pragma once

#include <string>
#include <vector>

#include <tether/campaign/result.h>

/// What UAVs touched, from the record.
namespace tether::campaign {

/// Of each UAV, in the order of the record's header.
std::vector<UavContacts> contacts_of(const record::Record& record, double max_speed_m_s);

/// The first contact that was harder than that, in one line; empty: there is none.
std::string why_crashed(const record::Record& record, double max_speed_m_s);

}  // namespace tether::campaign
