#include "pages/page_figures.h"

#include "pages/html.h"
#include "plots/plot_script.h"
#include "plots/svg.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_plan.h>
#include <tether/report/camera_frame.h>
#include <tether/report/plots.h>

namespace tether::report {
namespace {

constexpr std::size_t kFramesPerRecord = 4;
constexpr std::size_t kBytesOfFrames = 6'500'000;

std::filesystem::path record_file(const std::filesystem::path& folder, const std::string& scenario,
                                  const std::string& condition, std::uint64_t seed) {
  return folder / campaign::trial_folder(scenario, condition, seed) / "record.mcap";
}

std::vector<std::uint64_t> seeds_with_record(const campaign::ScenarioResults& scenario,
                                             const campaign::ConditionResults& condition,
                                             const std::filesystem::path& folder) {
  std::vector<std::uint64_t> seeds;
  for (const campaign::TrialResult& trial : condition.trials) {
    const auto file = record_file(folder, scenario.scenario, condition.condition, trial.seed);
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored)) seeds.push_back(trial.seed);
  }
  return seeds;
}

std::optional<std::uint64_t> common_seed(const std::vector<std::vector<std::uint64_t>>& seeds) {
  std::optional<std::uint64_t> least;
  for (const std::uint64_t seed : seeds.empty() ? std::vector<std::uint64_t>{} : seeds.front()) {
    const bool everywhere = std::ranges::all_of(seeds, [&](const auto& of_condition) {
      return std::ranges::find(of_condition, seed) != of_condition.end();
    });
    if (everywhere && (!least || seed < *least)) least = seed;
  }
  return least;
}

void add_record(SeedRecords& all, std::size_t series, const std::string& condition,
                const std::filesystem::path& file) {
  try {
    all.records.push_back({series, condition, record::read_record(file, {.images = true})});
    const std::string damage = record::describe_damage(all.records.back().record);
    if (!damage.empty())
      all.unreadable.push_back(
          fmt::format("{}: only the part before the damage is shown: {}", file.string(), damage));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kBadFile) throw;
    all.unreadable.emplace_back(error.what());
  }
}

std::string frames_html(const record::Record& record, std::size_t shown) {
  std::string html;
  for (const std::size_t i : thinned(record.images.size(), shown)) {
    const record::Image& image = record.images[i].message;
    html += fmt::format("<figure>{}</figure>\n",
                        frame_svg(image, find_roi(record, image), find_true_roi(record, image),
                                  ImageQuality::kSmall));
  }
  for (const bool depths : {true, false}) {
    std::vector<const record::RawImage*> images;
    for (const auto& logged : record.raw_images) {
      if (is_depth(logged.message) == depths) images.push_back(&logged.message);
    }
    for (const std::size_t i : thinned(images.size(), shown)) {
      html += fmt::format("<figure>{}</figure>\n",
                          raw_frame_svg(record, *images[i], ImageQuality::kSmall));
    }
  }
  return html;
}

}  // namespace

FigureMaker::FigureMaker(std::size_t frame_groups)
    : bytes_per_group_(kBytesOfFrames / std::max<std::size_t>(1, frame_groups)) {}

std::string FigureMaker::plot(const std::optional<Plot>& plot, const std::string& caption) {
  if (!plot) return "";
  const std::string prefix = fmt::format("f{}-", ++figures_);
  return figure(inline_svg(draw_svg(*plot), prefix), caption, "plot");
}

std::string FigureMaker::frames(const record::Record& record) const {
  std::string html;
  for (std::size_t shown = kFramesPerRecord; shown > 0; --shown) {
    html = frames_html(record, shown);
    if (html.size() <= bytes_per_group_) break;
    html.clear();
  }
  return html.empty() ? "" : "<div class=\"frames\">\n" + html + "</div>\n";
}

SeedRecords read_seed_records(const campaign::ScenarioResults& scenario,
                              const std::filesystem::path& folder) {
  std::vector<std::vector<std::uint64_t>> seeds;
  for (const campaign::ConditionResults& condition : scenario.conditions)
    seeds.push_back(seeds_with_record(scenario, condition, folder));
  std::vector<std::vector<std::uint64_t>> with_any = seeds;
  std::erase_if(with_any, [](const auto& of_condition) { return of_condition.empty(); });
  const std::optional<std::uint64_t> common = common_seed(with_any);
  SeedRecords all;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    if (seeds[i].empty()) continue;
    const std::string& condition = scenario.conditions[i].condition;
    add_record(
        all, i, condition,
        record_file(folder, scenario.scenario, condition, common.value_or(seeds[i].front())));
  }
  return all;
}

}  // namespace tether::report
