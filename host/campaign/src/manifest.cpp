#include "json_reader.h"

#include <tether/campaign/campaign_folder.h>
#include <tether/os/text_file.h>

namespace tether::campaign {
namespace {

Json json_of(const CampaignManifest::Entry& entry) {
  Json json{{"scenario", entry.scenario},
            {"description", entry.description},
            {"paper_table", entry.paper_table},
            {"conditions", entry.conditions},
            {"metrics", entry.metrics}};
  if (entry.swept_from.empty()) return json;
  json["swept_from"] = entry.swept_from;
  for (const auto& [key, value] : entry.settings)
    json["settings"].push_back(Json{{"key", key}, {"value", value}});
  return json;
}

CampaignManifest::Entry read_entry(const JsonReader& json) {
  CampaignManifest::Entry entry{json.text("scenario"), json.text("description"),
                                json.text("paper_table"), json.texts("conditions"),
                                json.texts("metrics")};
  if (!json.has("swept_from")) return entry;
  entry.swept_from = json.text("swept_from");
  for (const JsonReader& setting : json.objects("settings"))
    entry.settings.push_back({setting.text("key"), setting.text("value")});
  return entry;
}

}  // namespace

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
  Json scenarios = Json::array();
  for (const auto& entry : manifest.scenarios) scenarios.push_back(json_of(entry));
  const Json json{{"schema", kCampaignSchemaVersion},
                  {"campaign", manifest.name},
                  {"description", manifest.description},
                  {"seeds", manifest.seeds},
                  {"scenarios", scenarios},
                  {"settings", manifest.settings}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

CampaignManifest read_manifest(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kCampaignFile;
  const Json document = parse_json(os::read_file(file), file);
  const JsonReader json(document, file);
  json.require_schema(kCampaignSchemaVersion);
  CampaignManifest manifest{json.text("campaign"),
                            json.text("description"),
                            json.counts("seeds"),
                            {},
                            json.object("settings").all_texts()};
  for (const JsonReader& entry : json.objects("scenarios")) {
    manifest.scenarios.push_back(read_entry(entry));
  }
  return manifest;
}

}  // namespace tether::campaign
