#include "commands.h"
#include "file_kind.h"
#include "output_folder.h"
#include "say.h"

#include <filesystem>
#include <set>
#include <string>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/os/text_file.h>
#include <tether/record/reader.h>
#include <tether/report/camera_frame.h>

namespace tether::app {

namespace {

std::string why_no_images(const record::Record& record) {
  if (record.damage.empty())
    return "the record has no images. To record images, type: tether run SCENARIO --images";
  return fmt::format(
      "the record has no images up to the damage: {}. Run the trial again with --images",
      record::describe_damage(record));
}

record::Record read_images(const std::filesystem::path& file) {
  record::Record record = record::read_record(file, {.images = true});
  if (record.images.empty())
    throw Error(ErrorCode::kBadFile, {file.string()}, why_no_images(record));
  if (!record.damage.empty())
    say("tether: {}: drawn up to the damage: {}\n", file.string(), record::describe_damage(record));
  return record;
}

std::string file_name_of(const record::Image& image) {
  return fmt::format("{}-{}-{:06}.svg", os::file_name_of(image.uav), os::file_name_of(image.sensor),
                     image.index);
}

}  // namespace

int draw_frames(const FramesOptions& options, const std::stop_token&) {
  require_kind(options.record, FileKind::kRecord);
  const record::Record record = read_images(options.record);
  std::set<std::string> names;
  for (const auto& logged : record.images) names.insert(file_name_of(logged.message));
  const auto out = make_output_folder(options.out, options.record, "frames", names,
                                      "*-*-[0-9][0-9][0-9][0-9][0-9][0-9].svg");
  for (const auto& logged : record.images) {
    const record::Image& image = logged.message;
    os::write_file_atomically(out / file_name_of(image),
                              report::frame_svg(image, report::find_roi(record, image),
                                                report::find_true_roi(record, image)));
  }
  fmt::print("{} images in {}\n", record.images.size(), out.string());
  return 0;
}

}  // namespace tether::app
