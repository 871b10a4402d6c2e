#include "fields.h"

#include <tether/campaign/campaign_folder.h>
#include <tether/os/text_file.h>

namespace tether::campaign {

void fields(auto& io, Maybe<Setting> auto& m) {
  io("key", m.key);
  io("value", m.value);
}

void fields(auto& io, Maybe<CampaignManifest::Entry> auto& m) {
  io("scenario", m.scenario);
  io("description", m.description);
  io("paper_table", m.paper_table);
  io("conditions", m.conditions);
  io("metrics", m.metrics);
  io.some("swept_from", m.swept_from);
  if (!m.swept_from.empty()) io.some("settings", m.settings);
}

void fields(auto& io, Maybe<CampaignManifest> auto& m) {
  io("campaign", m.name);
  io("description", m.description);
  io("seeds", m.seeds);
  io("scenarios", m.scenarios);
  io("settings", m.settings);
}

CampaignManifest manifest_of(const scenario::Campaign& campaign, Settings settings) {
  CampaignManifest manifest{
      campaign.name, campaign.description, campaign.seeds, {}, std::move(settings)};
  for (const scenario::CampaignScenario& entry : campaign.scenarios) {
    std::vector<std::string> metrics;
    for (const scenario::Metric& metric : entry.scenario.metrics) metrics.push_back(metric.name);
    manifest.scenarios.push_back({entry.scenario.name, entry.scenario.description,
                                  entry.paper_table, entry.conditions, std::move(metrics),
                                  entry.swept_from, entry.scenario.settings});
  }
  return manifest;
}

std::string to_json(const CampaignManifest& manifest) {
  return text_of(manifest, kCampaignSchemaVersion);
}

CampaignManifest read_manifest(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kCampaignFile;
  return read_text<CampaignManifest>(os::read_file(file), file, kCampaignSchemaVersion);
}

}  // namespace tether::campaign
