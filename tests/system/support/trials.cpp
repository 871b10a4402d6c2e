#include "trials.h"

#include <algorithm>
#include <functional>
#include <stdexcept>

#include <tether/record/canonical.h>
#include <tether/record/writer.h>

namespace tether::system_test {
namespace {

constexpr const char* kToken = "token-of-the-system-tests";

std::filesystem::path data_file(const std::string& name) {
  return std::filesystem::path(TETHER_TEST_DIR) / "data" / name;
}

std::string with_all(std::string text, const std::string& placeholder, const std::string& value) {
  while (text.find(placeholder) != std::string::npos)
    text = substituted(text, {{placeholder, value}});
  return text;
}

std::filesystem::path write_scenario(const std::filesystem::path& file, std::string text,
                                     const std::vector<Substitution>& substitutions) {
  text = with_all(text, "@SOURCE@", TETHER_SOURCE_DIR);
  write_text(file, substituted(text, substitutions));
  return file;
}

using Write = std::function<void(record::Recorder&)>;

template <class Message>
void append(std::vector<std::pair<std::uint64_t, Write>>& writes,
            const std::vector<record::Logged<Message>>& messages) {
  for (const auto& logged : messages)
    writes.emplace_back(logged.order, [&logged](record::Recorder& recorder) {
      recorder.write(logged.at, logged.message);
    });
}

}  // namespace

std::filesystem::path write_face_scenario(const std::filesystem::path& folder,
                                          const std::vector<Substitution>& substitutions) {
  const auto model = folder / "small_camera.sdf";
  write_text(model, substituted(read_text(std::filesystem::path(TETHER_SOURCE_DIR) /
                                          "data/models/hummingbird/model.sdf"),
                                {{"<width>640</width>", "<width>320</width>"},
                                 {"<height>480</height>", "<height>240</height>"}}));
  return write_scenario(folder / "face.toml",
                        with_all(read_text(data_file("face_anchor.toml")), "@MODEL@", model),
                        substitutions);
}

std::filesystem::path write_hover_scenario(const std::filesystem::path& folder,
                                           const std::string& mode,
                                           const std::vector<Substitution>& substitutions) {
  return write_scenario(
      folder / "hover.toml",
      substituted(read_text(data_file("hover.toml")),
                  {{"@WORLD@", hover_world()}, {"@BAD_SUT@", bad_sut_program()}, {"@MODE@", mode}}),
      substitutions);
}

std::filesystem::path hover_world() {
  return data_file("hover.sdf");
}

std::filesystem::path write_shipped_scenario(const std::filesystem::path& folder,
                                             const std::string& name,
                                             const std::vector<Substitution>& substitutions) {
  const std::filesystem::path sources = TETHER_SOURCE_DIR "/data";
  for (const char* data : {"worlds", "models", "profiles", "missions"})
    std::filesystem::create_directory_symlink(sources / data, folder / data);
  const auto file = folder / "scenarios" / (name + ".toml");
  std::filesystem::create_directory(file.parent_path());
  write_text(file, substituted(read_text(sources / "scenarios" / (name + ".toml")), substitutions));
  return file;
}

Substitution scripted_host(int computing_ms) {
  return {"clock = \"cpu\"\ncpu_factor = 1.0",
          "clock = \"scripted\"\ncomputing_ms = " + std::to_string(computing_ms)};
}

Command tether(const std::vector<std::string>& arguments, const std::string& mark) {
  Command command{.arguments = {tether_program()},
                  .environment = {{"TETHER_TEST_MARK", mark}},
                  .working_folder = {}};
  command.arguments.insert(command.arguments.end(), arguments.begin(), arguments.end());
  return command;
}

nlohmann::json read_result(const std::filesystem::path& folder) {
  return nlohmann::json::parse(read_text(folder / "result.json"));
}

record::Record read_record(const std::filesystem::path& folder) {
  return record::read_record(folder / "record.mcap", {.images = true});
}

std::string timeless_result(const std::filesystem::path& folder) {
  nlohmann::json result = read_result(folder);
  result.erase("this_run");
  result.erase("real_time_factor");
  return result.dump(1);
}

std::string timeless_record(const std::filesystem::path& folder) {
  return record::canonical(read_record(folder), {.arrivals = true});
}

void write_record(const std::filesystem::path& file, const record::Record& record) {
  std::vector<std::pair<std::uint64_t, Write>> writes;
  append(writes, record.interactions);
  append(writes, record.commands);
  append(writes, record.ground_truth);
  append(writes, record.annotations);
  append(writes, record.images);
  std::ranges::stable_sort(writes, {}, &std::pair<std::uint64_t, Write>::first);

  const auto recorder = record::make_mcap_recorder(file);
  recorder->write(record.header);
  for (const auto& [order, write] : writes) write(*recorder);
  if (record.footer) recorder->write(*record.footer);
}

ExternalRun::ExternalRun(const std::filesystem::path& scenario, const std::filesystem::path& out,
                         const std::vector<std::string>& options) {
  Command command = tether({"run", scenario, "--out", out, "--target", "wait", "--quiet"});
  command.arguments.insert(command.arguments.end(), options.begin(), options.end());
  command.environment.emplace_back("TETHER_TOKEN", kToken);
  tether_ = std::make_unique<Process>(command);

  const std::string key = "TETHER_ADDRESS=";
  const bool listens = tether_->wait_for_err(" TETHER_TOKEN=", std::chrono::seconds(90));
  const std::string text = tether_->err();
  if (!listens) throw std::runtime_error("tether does not listen: " + text);
  const auto begin = text.find(key) + key.size();
  address_ = text.substr(begin, text.find(' ', begin) - begin);
}

std::string ExternalRun::token() {
  return kToken;
}

std::unique_ptr<Process> ExternalRun::start_sut(
    const std::vector<std::string>& arguments,
    const std::vector<std::pair<std::string, std::string>>& environment) const {
  Command command{.arguments = arguments,
                  .environment = {{"TETHER_ADDRESS", address_},
                                  {"TETHER_TOKEN", kToken},
                                  {"TETHER_CLOCK", "scripted*2"}},
                  .working_folder = {}};
  command.environment.insert(command.environment.end(), environment.begin(), environment.end());
  return std::make_unique<Process>(command);
}

std::vector<std::string> face_sut() {
  return {
      sut_program(),      "face_anchor", "--anchor",        "blue_box", "--precision-deg",     "3",
      "--yaw-rate-deg-s", "25",          "--prefilter",     "median",   "--prefilter-size-px", "5",
      "--tolerance-px",   "4",           "--stable-frames", "2"};
}

}  // namespace tether::system_test
