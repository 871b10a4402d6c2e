#pragma once

#include <map>
#include <string>
#include <vector>

#include <tether/record/reader.h>

namespace tether::audit {

/// One SUT of the header with its messages.
struct SutRow {
  const record::SutInfo* info = nullptr;
  std::vector<const record::Logged<record::Interaction>*> interactions;    ///< in file order
  std::vector<const record::Logged<record::Stop>*> stops;                  ///< in file order
  std::vector<const record::Logged<record::AutopilotMessage>*> autopilot;  ///< in file order
};

/// By UAV. Messages of other UAVs are left out: check_consistency reports them.
inline std::map<std::string, SutRow> rows_of(const record::Record& record) {
  std::map<std::string, SutRow> rows;
  for (const record::SutInfo& sut : record.header.suts) rows[sut.uav].info = &sut;
  const auto add_all = [&](const auto& messages, auto list) {
    for (const auto& entry : messages) {
      if (const auto row = rows.find(entry.message.uav); row != rows.end())
        (row->second.*list).push_back(&entry);
    }
  };
  add_all(record.interactions, &SutRow::interactions);
  add_all(record.stops, &SutRow::stops);
  add_all(record.autopilot, &SutRow::autopilot);
  return rows;
}

}  // namespace tether::audit
