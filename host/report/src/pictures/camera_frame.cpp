#include "pictures/captioned_picture.h"
#include "pictures/jpeg.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tether/record/png.h>
#include <tether/record/reader.h>
#include <tether/report/camera_frame.h>

// The region of interest (ROI) that the SUT reported for an image, and the true one, are searched
// in the record; frame_svg draws both over the image with a caption below.
namespace tether::report {
namespace {

struct PixelSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

// A PNG file has its width and height at bytes 16 and 20, big-endian (RFC 2083, section 3.3).
PixelSize size_of_png(std::span<const std::uint8_t> png) {
  constexpr std::size_t kWidthAt = 16, kHeightAt = 20, kHeaderBytes = 24;
  if (png.size() < kHeaderBytes) return {};
  const auto number = [&](std::size_t at) {
    return std::uint32_t{png[at]} << 24 | std::uint32_t{png[at + 1]} << 16 |
           std::uint32_t{png[at + 2]} << 8 | std::uint32_t{png[at + 3]};
  };
  return {number(kWidthAt), number(kHeightAt)};
}

// An annotation without a camera applies to the images of all cameras with that index.
std::optional<ReportedRoi> parse_roi(const std::string& text, const record::Image& image) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || json.value("image_index", nlohmann::json()) != image.index ||
      json.value("camera", nlohmann::json(image.sensor)) != image.sensor)
    return std::nullopt;
  ReportedRoi roi;
  for (const auto& [key, value] :
       {std::pair{"u_px", &roi.u_px}, std::pair{"v_px", &roi.v_px},
        std::pair{"width_px", &roi.width_px}, std::pair{"height_px", &roi.height_px}}) {
    const auto member = json.find(key);
    if (member == json.end() || !member->is_number()) return std::nullopt;
    *value = member->get<double>();
  }
  return roi;
}

// The part of an "estimate" annotation that is needed here.
struct Estimate {
  std::string anchor;
  std::uint64_t image_index = 0;
};

std::optional<Estimate> parse_estimate(const std::string& text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  const auto anchor = json.find("anchor"), index = json.find("image_index");
  if (anchor == json.end() || !anchor->is_string()) return std::nullopt;
  if (index == json.end() || !index->is_number_unsigned()) return std::nullopt;
  return Estimate{anchor->get<std::string>(), index->get<std::uint64_t>()};
}

std::optional<std::string> target_anchor(const record::Record& record, const record::Image& image) {
  std::optional<std::string> found;
  for (const auto& logged : record.annotations) {
    const record::Annotation& note = logged.message;
    if (note.uav != image.uav || note.topic != "estimate") continue;
    const auto estimate = parse_estimate(note.json);
    if (!estimate) continue;
    if (!found || estimate->image_index <= image.index) found = estimate->anchor;
  }
  if (!found && record.header.anchors.size() == 1) found = record.header.anchors.front().name;
  return found;
}

// Drawing.

std::string data_uri(const record::Image& image, ImageQuality quality) {
  if (quality == ImageQuality::kSmall) {
    if (const auto jpeg = jpeg_from_png(image.png)) return record::to_data_uri(*jpeg, "image/jpeg");
  }
  return record::to_data_uri(image.png);
}

constexpr const char* kTracked = "#ffd21f";
constexpr const char* kTrue = "#4de1ff";
constexpr const char* kDashes = R"( stroke-dasharray="7 4")";

CaptionedPicture::Line caption_line(const char* colour, bool dashed, std::string text) {
  return {fmt::format(R"(<line x1="10" x2="34" y1="-5" y2="-5" stroke="{}" stroke-width="2.5"{}/>)",
                      colour, dashed ? kDashes : ""),
          std::move(text)};
}

// Pixel centres have whole coordinates in a ROI, and halves in the image.
std::string framed(const campaign::PixelRect& rect, const char* colour, bool dashed) {
  return fmt::format(
      R"(<rect x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" fill="none" stroke="{}" stroke-width="2.5"{}/>)"
      "\n",
      rect.left_px + 0.5, rect.top_px + 0.5, rect.right_px - rect.left_px,
      rect.bottom_px - rect.top_px, colour, dashed ? kDashes : "");
}

campaign::PixelRect rect_of(const ReportedRoi& roi) {
  return {roi.u_px - roi.width_px / 2.0, roi.v_px - roi.height_px / 2.0,
          roi.u_px + roi.width_px / 2.0, roi.v_px + roi.height_px / 2.0};
}

std::string size_text(const campaign::PixelRect& rect) {
  return fmt::format("{:.0f} x {:.0f} px", rect.right_px - rect.left_px,
                     rect.bottom_px - rect.top_px);
}

std::string text_of(const TrueRoi& roi) {
  if (!roi.rect) return "the anchor is not visible in this image (ground truth)";
  return std::string(roi.is_of_pixels ? "true ROI (visible pixels), "
                                      : "true ROI (projection of the whole anchor), ") +
         size_text(*roi.rect);
}

}  // namespace

std::optional<ReportedRoi> find_roi(const record::Record& record, const record::Image& image) {
  for (const auto& logged : record.annotations) {
    const record::Annotation& note = logged.message;
    if (note.uav != image.uav || note.topic != "roi") continue;
    if (const auto roi = parse_roi(note.json, image)) return roi;
  }
  return std::nullopt;
}

std::optional<TrueRoi> find_true_roi(const record::Record& record, const record::Image& image) {
  const auto name = target_anchor(record, image);
  if (!name) return std::nullopt;
  const auto& anchors = record.header.anchors;
  const auto& sensors = record.header.sensors;
  const auto anchor = std::ranges::find(anchors, *name, &record::Anchor::name);
  const auto camera = std::ranges::find_if(sensors, [&](const record::SensorInfo& candidate) {
    return candidate.uav == image.uav && candidate.name == image.sensor && candidate.camera;
  });
  const auto X_WB = record::pose_at(record, image.uav, image.at);
  if (anchor == anchors.end() || camera == sensors.end() || !X_WB) return std::nullopt;
  const record::Anchor now = record::AnchorTrack(*anchor, record).at(image.at);
  const record::SensorInfo mounted = mounted_at(*camera, record, image.at);
  const auto* read = campaign::find_read(record, image.uav, image.sensor, image.index);
  const auto roi = read == nullptr ? campaign::true_roi(mounted, *X_WB, now)
                                   : campaign::roi_in_image(*read, mounted, *X_WB, now);
  return TrueRoi{roi ? campaign::visible_part(mounted, *roi) : std::nullopt,
                 read != nullptr && read->seen_anchors.has_value()};
}

std::string frame_svg(const record::Image& image, const std::optional<ReportedRoi>& roi,
                      const std::optional<TrueRoi>& true_roi, ImageQuality quality) {
  const PixelSize size = size_of_png(image.png);
  CaptionedPicture picture{
      size.width,
      size.height,
      data_uri(image, quality),
      "Camera image",
      fmt::format("{} / {}, ST {:.3f} s", image.uav, image.sensor, to_seconds(image.at)),
      ""};
  // If the two coincide, the solid line is visible between the dashes.
  if (roi) picture.drawings += framed(rect_of(*roi), kTracked, false);
  if (true_roi && true_roi->rect) picture.drawings += framed(*true_roi->rect, kTrue, true);
  picture.lines.push_back(caption_line(
      kTracked, false,
      roi ? "ROI tracked by the SUT, " + size_text(rect_of(*roi)) : "no ROI reported by the SUT"));
  if (true_roi) picture.lines.push_back(caption_line(kTrue, true, text_of(*true_roi)));
  return to_svg(picture);
}

}  // namespace tether::report
