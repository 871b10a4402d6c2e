#include "commands.h"

#include "progress_line.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <ostream>
#include <utility>

#include <tether/calibration/calibration.h>
#include <tether/calibration/characterize.h>
#include <tether/os/machine.h>
#include <tether/rig/png.h>

/// Each command runs its part of the libraries on a connection and prints the outcome: the mission
/// as one line of JSON, the real row and the characterization with tables before it.
namespace tether::sut {
namespace {

using tasks::TaskOutcome;

constexpr int kSetUpFailed = 3;

int say(const Failure& failure, int code, const Streams& streams) {
  streams.err << "tether-sut: " << failure.message << '\n';
  return code;
}

/// The JSON line, or the one line of a failure.
int report(const TaskOutcome& outcome, const Streams& streams) {
  if (outcome.status == tasks::TaskStatus::kFailed)
    streams.err << "tether-sut: " << outcome.reason << '\n';
  else
    streams.out << tasks::details_json(outcome) << '\n';
  return rig::exit_code(outcome);
}

// The real row ------------------------------------------------------------------------------------

Status keep_image(const std::string& path, const rig::RealRow& row, const Streams& streams) {
  if (path.empty()) return ok_status();
  if (!row.sighting) {
    streams.err << "tether-sut: " << path
                << " was not written, because no image shows the anchor\n";
    return ok_status();
  }
  const Result<std::string> png = rig::png_of(row.sighting->image);
  if (!png) return Failure{png.failure().kind, path + ": " + png.failure().message};
  if (Status written = calibration::write_whole(path, *png); !written) return written;
  streams.out << path << ": image " << row.sighting->image.index
              << "; tracked ROI, in the format of --true-roi-px: "
              << rig::to_pixel_box(row.sighting->roi) << '\n';
  return ok_status();
}

// Characterization --------------------------------------------------------------------------------

std::string source_of(const CommandLine& line, const std::string& sensor) {
  if (!line.rig) return "virtual";
  const auto& sensors = line.rig->sensors;
  const auto found = std::find_if(sensors.begin(), sensors.end(), [&](const auto& candidate) {
    return candidate.description.name == sensor;
  });
  return found == sensors.end() ? "real sensor" : found->device;
}

/// Whether the times of a sensor may be arrival times: not for virtual sensors and video files.
bool may_stamp_arrival(const CommandLine& line, const std::string& sensor) {
  std::error_code error;
  return line.rig && !std::filesystem::is_regular_file(source_of(line, sensor), error);
}

/// Adds a note for each sensor whose model is not the requested one.
Result<calibration::MeasuredProfile> make_profile(const CommandLine& line,
                                                  const Connection& connection,
                                                  const std::vector<calibration::SensorTimes>& all,
                                                  std::vector<std::string>& notes) {
  const calibration::CharacterizeOptions& options = *line.characterize;
  calibration::MeasuredProfile profile;
  profile.name = options.name.empty() ? calibration::profile_name_from(calibration::host_name())
                                      : options.name;
  profile.when = os::utc_now();
  profile.where = connection.origin.location;
  profile.acquisitions = options.acquisitions;
  profile.experiments = options.experiments;
  for (const calibration::SensorTimes& times : all) {
    Result<calibration::ChosenTiming> timing =
        choose_timing(times, options.timing, may_stamp_arrival(line, times.sensor));
    if (!timing) return timing.failure();
    if (!timing->note.empty()) notes.push_back(timing->note);
    profile.sensors.push_back(
        {times.sensor, times.kind, source_of(line, times.sensor), std::move(timing->model)});
  }
  return profile;
}

/// "Timing models: camera periodic, range on_demand".
std::string models_text(const calibration::MeasuredProfile& profile) {
  std::string text;
  for (const calibration::ProfiledSensor& sensor : profile.sensors) {
    text += (text.empty() ? "Timing models: " : ", ") + sensor.name +
            (sensor.timing.period ? " periodic" : " on_demand");
  }
  return text;
}

/// The acquisition times of each sensor, and for a periodic sensor the period and delay of its
/// profile.
std::vector<calibration::NamedTimes> rows_of(const std::vector<calibration::SensorTimes>& all,
                                             const calibration::MeasuredProfile& profile) {
  std::vector<calibration::NamedTimes> rows;
  for (std::size_t i = 0; i < all.size(); ++i) {
    rows.push_back({all[i].sensor, all[i].taken(), stddev_between_experiments_s(all[i])});
    const calibration::TimingModel& timing = profile.sensors[i].timing;
    if (timing.period) {
      rows.push_back({all[i].sensor + " period", {*timing.period}, std::nullopt});
      rows.push_back({all[i].sensor + " delay", timing.delays, std::nullopt});
    }
  }
  return rows;
}

calibration::Characterization measure(const CommandLine& line, const Connection& connection) {
  ProgressLine progress;
  return characterize(*connection.vehicle, *line.characterize,
                      [&progress](const std::string& what) { progress.show(what); });
}

}  // namespace

int fly_command(const CommandLine& line, client::Vehicle& vehicle, const Streams& streams) {
  return report(fly(line.mission, vehicle), streams);
}

int real_row_command(const CommandLine& line, const Connection& connection,
                     const Streams& streams) {
  const rig::RealRow row =
      measure_real_row(line.mission.tasks.front(), line.real_row.true_roi, *connection.vehicle);
  if (row.outcome.failure) return report(row.outcome, streams);
  for (const std::string& note : row.notes) streams.err << "tether-sut: " << note << '\n';
  if (const Status kept = keep_image(line.real_row.keep_image, row, streams); !kept)
    return say(kept.failure(), kSetUpFailed, streams);
  if (row.outcome.reached()) streams.out << table_2(row, connection.origin.location);
  return report(rig::finish(row.outcome, *connection.vehicle), streams);
}

int characterize_command(const CommandLine& line, const Connection& connection,
                         const Streams& streams) {
  const calibration::Characterization measured = measure(line, connection);
  if (!measured.outcome.reached())
    return report(rig::finish(measured.outcome, *connection.vehicle), streams);
  std::vector<std::string> notes;
  const Result<calibration::MeasuredProfile> profile =
      make_profile(line, connection, measured.sensors, notes);
  if (!profile) return say(profile.failure(), rig::exit_code(profile.failure()), streams);
  const std::string& out = line.characterize->out;
  if (!out.empty()) {
    if (const Status good = check_delays(*profile); !good)
      return say(good.failure(), rig::exit_code(good.failure()), streams);
    if (const Status written = calibration::write_whole(out, profile_text(*profile)); !written)
      return say(written.failure(), kSetUpFailed, streams);
  }
  for (const std::string& note : notes) streams.err << "tether-sut: " << note << '\n';
  streams.out << table_1(connection.origin, measured.sensors) << '\n'
              << distribution_table(rows_of(measured.sensors, *profile)) << models_text(*profile)
              << '\n';
  return report(rig::finish(measured.outcome, *connection.vehicle), streams);
}

int calibrate_command(const calibration::CalibrateOptions& options, const Streams& streams) {
  std::optional<Result<std::string>> made;
  {
    ProgressLine progress;
    made = calibrate(options, [&progress](const std::string& what) { progress.show(what); });
  }
  if (!*made) return say(made->failure(), rig::exit_code(made->failure()), streams);
  streams.out << **made;
  return 0;
}

int run_command(const CommandLine& line, const Streams& streams) {
  if (line.calibrate) return calibrate_command(*line.calibrate, streams);
  const std::string& file = line.characterize ? line.characterize->out : line.real_row.keep_image;
  if (!file.empty()) {
    if (const Status writable = calibration::check_writable(file); !writable)
      return say(writable.failure(), rig::exit_code(writable.failure()), streams);
  }
  const Result<Connection> connection = connect_as(line);
  if (!connection) return say(connection.failure(), rig::exit_code(connection.failure()), streams);
  if (line.characterize) return characterize_command(line, *connection, streams);
  const std::vector<rig::TaskSpec>& specs = line.mission.tasks;
  const bool is_real_row =
      connection->is_real && !line.mission.is_sequence &&
      std::holds_alternative<tasks::RelativePositionOptions>(specs.front().options);
  return is_real_row ? real_row_command(line, *connection, streams)
                     : fly_command(line, *connection->vehicle, streams);
}

}  // namespace tether::sut
