#include "fuzz_target.h"

#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/campaign_results.h>
#include <tether/campaign/result.h>

/// What a campaign leaves in its folder and reads back to resume or report: result.json and
/// campaign.json. Input: the file, read as both.
namespace tether::fuzz {
namespace {

void check_result(const InputFolder& folder, const std::string& text) {
  const auto read = read_or_refuse([&] { return campaign::result_from_json(text, "result.json"); });
  if (!read) return;
  const std::string again = campaign::to_json(*read);
  require(campaign::result_from_json(again, "result.json") == *read,
          "a result that says something else once written: " + again);
  (void)folder;
}

void check_manifest(const InputFolder& folder) {
  const auto read = read_or_refuse([&] { return campaign::read_manifest(folder.path()); });
  if (!read) return;
  const std::string again = campaign::to_json(*read);
  folder.write(std::string(campaign::kCampaignFile), std::string_view(again));
  require(campaign::read_manifest(folder.path()) == *read,
          "a plan that says something else once written: " + again);
  (void)read_or_refuse([&] { return campaign::read_campaign_results(folder.path()); });
}

}  // namespace
}  // namespace tether::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  static const fuzz::InputFolder folder;
  const fuzz::Bytes input{data, size};
  folder.write(std::string(campaign::kCampaignFile), input);
  fuzz::check_result(folder, fuzz::text_of(input));
  fuzz::check_manifest(folder);
  return 0;
}
