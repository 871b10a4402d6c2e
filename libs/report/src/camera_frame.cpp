#include <array>
#include <cstdint>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tether/record/png.h>
#include <tether/report/camera_frame.h>

namespace tether::report {

namespace {

struct PixelSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

// Width and height stand big-endian at bytes 16 and 20 of every PNG file (RFC 2083, section 3.3).
PixelSize size_of_png(std::span<const std::uint8_t> png) {
  constexpr std::size_t kWidthAt = 16, kHeightAt = 20, kHeaderBytes = 24;
  if (png.size() < kHeaderBytes) return {};
  const auto number = [&](std::size_t at) {
    return std::uint32_t{png[at]} << 24 | std::uint32_t{png[at + 1]} << 16 |
           std::uint32_t{png[at + 2]} << 8 | std::uint32_t{png[at + 3]};
  };
  return {number(kWidthAt), number(kHeightAt)};
}

std::optional<ReportedRoi> parse_roi(const std::string& text, std::uint64_t image_index) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || json.value("image_index", nlohmann::json()) != image_index)
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

}  // namespace

std::optional<ReportedRoi> find_roi(const record::Record& record, const record::Image& image) {
  for (const auto& logged : record.annotations) {
    const record::Annotation& note = logged.message;
    if (note.uav != image.uav || note.topic != "roi") continue;
    if (const auto roi = parse_roi(note.json, image.index)) return roi;
  }
  return std::nullopt;
}

std::string frame_svg(const record::Image& image, const std::optional<ReportedRoi>& roi) {
  constexpr unsigned kCaption_px = 28;
  const PixelSize size = size_of_png(image.png);
  std::string svg = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" viewBox="0 0 {0} {1}" font-family="sans-serif">)"
      "\n"
      R"(<rect width="{0}" height="{1}" fill="#1b1b1b"/><image width="{0}" height="{2}" href="{3}"/>)"
      "\n",
      size.width, size.height + kCaption_px, size.height, record::to_data_uri(image.png));
  std::string what = "anchor not found";
  if (roi) {
    // Pixel centres lie at whole coordinates in the ROI, at halves in the picture.
    svg += fmt::format(
        R"(<rect x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" fill="none" stroke="#ffd21f" stroke-width="2.5"/>)"
        "\n",
        roi->u_px + 0.5 - roi->width_px / 2.0, roi->v_px + 0.5 - roi->height_px / 2.0,
        roi->width_px, roi->height_px);
    what = fmt::format("tracked ROI {:.0f} x {:.0f} px", roi->width_px, roi->height_px);
  }
  svg += fmt::format(
      R"(<text x="10" y="{}" font-size="15" fill="#f2f2f2">{} / {}   ST {:.3f} s   {}</text>)"
      "\n</svg>\n",
      size.height + kCaption_px - 9, image.uav, image.sensor, to_seconds(image.at), what);
  return svg;
}

}  // namespace tether::report
