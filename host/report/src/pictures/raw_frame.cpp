#include "pictures/captioned_picture.h"
#include "pictures/jpeg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <tether/record/png.h>
#include <tether/report/camera_frame.h>

// Depths and labels as colours that a person can tell apart, with a caption that says what they
// mean.
namespace tether::report {
namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr Colour kNothing{0, 0, 0};
constexpr Colour kTooNear{200, 30, 60};

CaptionedPicture::Line line(const Colour& colour, std::string text) {
  return {
      fmt::format(R"-(<rect x="10" y="-11" width="24" height="12" fill="rgb({})" stroke="#888"/>)-",
                  fmt::join(colour, ",")),
      std::move(text)};
}

std::string share(std::size_t pixels, std::size_t of) {
  return fmt::format("{:.0f} %", 100.0 * static_cast<double>(pixels) / static_cast<double>(of));
}

// Depths.

/// From 0, the nearest, to 1: from light yellow to dark blue.
Colour colour_of_depth(double part) {
  constexpr std::array<std::array<double, 3>, 4> kScale{
      {{255, 245, 160}, {240, 140, 60}, {140, 45, 120}, {25, 15, 80}}};
  const double place = 3.0 * std::clamp(part, 0.0, 1.0);
  const auto below = std::min<std::size_t>(static_cast<std::size_t>(place), 2);
  Colour colour;
  for (std::size_t i = 0; i < 3; ++i) {
    colour[i] = static_cast<std::uint8_t>(std::lround(
        std::lerp(kScale[below][i], kScale[below + 1][i], place - static_cast<double>(below))));
  }
  return colour;
}

struct DepthSummary {
  float nearest_m = 0.0F, farthest_m = 0.0F;  ///< of the finite ones
  std::size_t finite = 0, nearer = 0;
};

DepthSummary summarise(std::span<const float> depths_m) {
  DepthSummary summary;
  for (const float depth_m : depths_m) {
    if (std::isinf(depth_m) && depth_m < 0.0F) ++summary.nearer;
    if (!std::isfinite(depth_m)) continue;
    const bool is_first = summary.finite++ == 0;
    summary.nearest_m = is_first ? depth_m : std::min(summary.nearest_m, depth_m);
    summary.farthest_m = is_first ? depth_m : std::max(summary.farthest_m, depth_m);
  }
  return summary;
}

std::vector<Colour> draw(std::span<const float> depths_m, CaptionedPicture& picture) {
  const DepthSummary summary = summarise(depths_m);
  const double range_m = std::max(1e-6, double{summary.farthest_m} - double{summary.nearest_m});
  std::vector<Colour> colours;
  for (const float depth_m : depths_m) {
    if (std::isfinite(depth_m)) {
      colours.push_back(colour_of_depth((double{depth_m} - double{summary.nearest_m}) / range_m));
    } else {
      colours.push_back(std::isinf(depth_m) && depth_m < 0.0F ? kTooNear : kNothing);
    }
  }
  if (summary.finite > 0) {
    picture.lines.push_back(
        line(colour_of_depth(0.0), fmt::format("nearest depth: {:.2f} m", summary.nearest_m)));
    picture.lines.push_back(
        line(colour_of_depth(1.0), fmt::format("farthest depth: {:.2f} m", summary.farthest_m)));
  }
  const std::size_t all = depths_m.size(), without = all - summary.finite - summary.nearer;
  if (without > 0)
    picture.lines.push_back(line(kNothing, "too far, or nothing: " + share(without, all)));
  if (summary.nearer > 0)
    picture.lines.push_back(line(kTooNear, "too near: " + share(summary.nearer, all)));
  return colours;
}

// Labels.

/// Neighbouring labels have hues far apart. 0 is the background.
Colour colour_of_label(std::uint16_t label) {
  if (label == 0) return kNothing;
  const double hue = 6.0 * std::fmod(0.61803398875 * label, 1.0);
  const double value = label % 3 == 0 ? 150.0 : 235.0;
  Colour colour;
  for (std::size_t i = 0; i < 3; ++i) {
    const double distance = std::abs(std::remainder(hue - 2.0 * static_cast<double>(i), 6.0));
    colour[i] =
        static_cast<std::uint8_t>(value * (0.25 + 0.75 * std::clamp(2.0 - distance, 0.0, 1.0)));
  }
  return colour;
}

std::string name_of(const record::Record& record, const record::RawImage& image,
                    std::uint16_t label) {
  for (const record::SensorInfo& sensor : record.header.sensors) {
    if (sensor.uav != image.uav || sensor.name != image.sensor || !sensor.camera) continue;
    if (label <= sensor.camera->models.size()) return sensor.camera->models[label - 1U];
  }
  return fmt::format("label {}", label);
}

std::vector<Colour> draw(const record::Record& record, const record::RawImage& image,
                         std::span<const std::uint16_t> labels, CaptionedPicture& picture) {
  constexpr std::size_t kMostNames = 6;
  std::map<std::uint16_t, std::size_t> pixels;
  std::vector<Colour> colours;
  for (const std::uint16_t label : labels) {
    colours.push_back(colour_of_label(label));
    if (label != 0) ++pixels[label];
  }
  std::vector<std::pair<std::uint16_t, std::size_t>> largest(pixels.begin(), pixels.end());
  std::ranges::stable_sort(largest, std::greater{}, &std::pair<std::uint16_t, std::size_t>::second);
  for (std::size_t i = 0; i < std::min(largest.size(), kMostNames); ++i) {
    const auto [label, count] = largest[i];
    picture.lines.push_back(
        line(colour_of_label(label),
             fmt::format("{}: {}", name_of(record, image, label), share(count, labels.size()))));
  }
  if (largest.size() > kMostNames) {
    picture.lines.push_back({"", fmt::format("and {} more", largest.size() - kMostNames)});
  }
  return colours;
}

std::string data_uri(const record::RawImage& image, const std::vector<Colour>& colours,
                     ImageQuality quality) {
  std::vector<std::uint8_t> rgb;
  for (const Colour& colour : colours) rgb.insert(rgb.end(), colour.begin(), colour.end());
  const auto png = record::encode_png(image.width_px, image.height_px, rgb);
  // Labels have few colours and sharp edges: as a PNG, they are small.
  if (quality == ImageQuality::kSmall && is_depth(image)) {
    if (const auto jpeg = jpeg_from_png(png)) return record::to_data_uri(*jpeg, "image/jpeg");
  }
  return record::to_data_uri(png);
}

}  // namespace

bool is_depth(const record::RawImage& image) {
  return std::holds_alternative<std::vector<float>>(image.pixels);
}

std::string raw_frame_svg(const record::Record& record, const record::RawImage& image,
                          ImageQuality quality) {
  CaptionedPicture picture{static_cast<unsigned>(image.width_px),
                           static_cast<unsigned>(image.height_px),
                           "",
                           is_depth(image) ? "Depths" : "Labels",
                           fmt::format("{} / {}, {}, ST {:.3f} s", image.uav, image.sensor,
                                       is_depth(image) ? "depths" : "models", to_seconds(image.at)),
                           ""};
  const auto* const depths_m = std::get_if<std::vector<float>>(&image.pixels);
  const std::vector<Colour> colours =
      depths_m ? draw(*depths_m, picture)
               : draw(record, image, std::get<std::vector<std::uint16_t>>(image.pixels), picture);
  picture.data_uri = data_uri(image, colours, quality);
  return to_svg(picture);
}

}  // namespace tether::report
