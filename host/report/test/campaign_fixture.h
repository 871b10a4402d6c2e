#pragma once

#include <filesystem>

#include <gtest/gtest.h>

#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/campaign_results.h>
#include <tether/campaign_testing/sample_campaign.h>

namespace tether::report {

/// A campaign's folder with three trials for each of the three conditions of `make_campaign`.
class CampaignFixture : public testing::Test {
 protected:
  CampaignFixture() {
    campaign::CampaignFolder folder(out_, campaign_, {{"tether", "0.1.0"}},
                                    campaign::OpenMode::kFresh);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const double s = static_cast<double>(seed);
      write(trial("host", seed, 0, 2.4 + 0.1 * s));
      write(trial("target", seed, s - 1, 4.0 * s));
      write(trial("target, no sync", seed, 0, 2.3 + 0.2 * s));
    }
  }
  campaign::TrialResult trial(const std::string& condition, std::uint64_t seed, double oscillations,
                              double time_s) const {
    return campaign::make_trial(scenario(), condition, seed, oscillations, time_s);
  }
  std::filesystem::path folder_of(const std::string& condition, std::uint64_t seed) const {
    return out_ / campaign::trial_folder("turn", condition, seed);
  }
  void write(const campaign::TrialResult& result) const {
    std::filesystem::create_directories(folder_of(result.condition, result.seed));
    write_result(folder_of(result.condition, result.seed), result);
  }
  const scenario::Scenario& scenario() const { return campaign_.scenarios[0].scenario; }
  campaign::CampaignResults all() const { return campaign::read_campaign_results(out_); }
  campaign::ScenarioResults results() const { return all().scenarios[0]; }

  ScratchFolder scratch_;
  std::filesystem::path out_ = scratch_.path("out");
  scenario::Campaign campaign_ = campaign::make_campaign(scratch_);
};

}  // namespace tether::report
