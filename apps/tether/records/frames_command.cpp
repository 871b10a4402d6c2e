#include "commands/commands.h"
#include "options/common_options.h"
#include "reading/file_kind.h"
#include "records/output_folder.h"
#include "terminal/say.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/os/text_file.h>
#include <tether/record/png.h>
#include <tether/record/reader.h>
#include <tether/report/camera_frame.h>

namespace tether::app {

namespace {

struct FramesOptions {
  std::filesystem::path record;
  std::filesystem::path out;
};

std::string why_no_images(const record::Record& record) {
  if (record.damage.empty())
    return "the record has no images. To record images, type: tether run SCENARIO --images";
  return fmt::format(
      "the record has no images up to the damage: {}. Run the trial again with --images",
      record::describe_damage(record));
}

record::Record read_images(const std::filesystem::path& file) {
  record::Record record = record::read_record(file, {.images = true});
  if (record.images.empty() && record.raw_images.empty())
    throw Error(ErrorCode::kBadFile, {file.string()}, why_no_images(record));
  if (!record.damage.empty())
    say("tether: {}: drawn up to the damage: {}\n", file.string(), record::describe_damage(record));
  return record;
}

std::string file_name_of(const auto& image, std::string_view end) {
  return fmt::format("{}-{}-{:06}{}", os::file_name_of(image.uav), os::file_name_of(image.sensor),
                     image.index, end);
}

struct Frame {
  std::string name;
  std::string (*content)(const record::Record&, std::size_t);
  std::size_t index;
};

std::string svg_of(const record::Record& record, std::size_t i) {
  const record::Image& image = record.images[i].message;
  return report::frame_svg(image, report::find_roi(record, image),
                           report::find_true_roi(record, image));
}

// As ROS and OpenCV do: whole millimetres, and 0 where nothing was measured. Beyond 65.535 m, too.
std::uint16_t millimetres(float depth_m) {
  const float depth_mm = std::round(1000.0F * depth_m);
  return depth_mm >= 0.0F && depth_mm <= 65535.0F ? static_cast<std::uint16_t>(depth_mm)
                                                  : std::uint16_t{0};
}

std::string png_of(const record::Record& record, std::size_t i) {
  const record::RawImage& image = record.raw_images[i].message;
  std::vector<std::uint16_t> grey;
  if (const auto* depths_m = std::get_if<std::vector<float>>(&image.pixels)) {
    std::ranges::transform(*depths_m, std::back_inserter(grey), millimetres);
  } else {
    grey = std::get<std::vector<std::uint16_t>>(image.pixels);
  }
  const auto png = record::encode_png(image.width_px, image.height_px, grey);
  return {png.begin(), png.end()};
}

std::vector<Frame> frames_of(const record::Record& record) {
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < record.images.size(); ++i)
    frames.push_back({file_name_of(record.images[i].message, ".svg"), svg_of, i});
  for (std::size_t i = 0; i < record.raw_images.size(); ++i) {
    const record::RawImage& image = record.raw_images[i].message;
    const bool is_depth = std::holds_alternative<std::vector<float>>(image.pixels);
    frames.push_back({file_name_of(image, is_depth ? "-depth.png" : "-labels.png"), png_of, i});
  }
  return frames;
}

/// Draws the recorded camera images with their ROIs.
int draw_frames(const FramesOptions& options, const std::stop_token&) {
  require_kind(options.record, FileKind::kRecord);
  const record::Record record = read_images(options.record);
  const std::vector<Frame> frames = frames_of(record);
  std::set<std::string> names;
  for (const Frame& frame : frames) names.insert(frame.name);
  const auto out = make_output_folder(options.out, options.record, "frames", names,
                                      "*-*-[0-9][0-9][0-9][0-9][0-9][0-9]@(.svg|-*.png)");
  for (const Frame& frame : frames)
    os::write_file_atomically(out / frame.name, frame.content(record, frame.index));
  fmt::print("{} images in {}\n", frames.size(), out.string());
  return 0;
}

Options frames_rows(FramesOptions& o) {
  return {record_argument(o.record),
          {"--out FOLDER", "Folder for the images [frames, next to the record]", &o.out}};
}

}  // namespace

Command frames_command() {
  return make_command(
      "frames",
      "Extract the recorded images: colours with the tracked and the true ROI (SVG), depths [mm] "
      "and labels (16-bit PNG)",
      frames_rows,
      R"(The run needs the option --images. A depth is 0 where nothing was measured, or beyond 65.535 m.

Example:
  tether run face_anchor --images --out out/images
  tether frames out/images/record.mcap)",
      draw_frames);
}

}  // namespace tether::app
