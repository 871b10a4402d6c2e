#include "trials.h"

#include <functional>
#include <map>
#include <stdexcept>

#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/record/writer.h>
#include <tether/record_testing/canonical.h>

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
  const std::filesystem::path sources = TETHER_SOURCE_DIR "/data/scenarios";
  const auto file = folder / "scenarios" / (name + ".toml");
  std::filesystem::create_directory(file.parent_path());
  // Which its program may be in.
  if (!std::filesystem::exists(folder / "programs"))
    std::filesystem::create_directory_symlink(TETHER_SOURCE_DIR "/data/programs",
                                              folder / "programs");
  write_text(file, substituted(read_text(sources / (name + ".toml")), substitutions));
  return file;
}

Substitution scripted_host(int computing_ms) {
  return {"clock = \"cpu\"\ncpu_factor = 1.0",
          "clock = \"scripted\"\ncomputing_ms = " + std::to_string(computing_ms)};
}

std::filesystem::path write_campaign(const std::filesystem::path& folder, int trials,
                                     const std::string& more) {
  write_text(folder / "campaign.toml", "name = \"small\"\ntrials = " + std::to_string(trials) +
                                           "\n\n[[scenario]]\nfile = \"hover.toml\"\n" + more);
  return folder / "campaign.toml";
}

Command tether(const std::vector<std::string>& arguments, const std::string& mark) {
  return with({{tether_program()}, {{"TETHER_TEST_MARK", mark}}}, arguments);
}

nlohmann::json read_result(const std::filesystem::path& folder) {
  return nlohmann::json::parse(read_text(folder / "result.json"));
}

record::Record read_record(const std::filesystem::path& folder) {
  return record::read_record(folder / "record.mcap", {.images = true});
}

std::optional<record::Record> record_so_far(const std::filesystem::path& folder) try {
  return read_record(folder);
} catch (const Error&) {
  return std::nullopt;
}

int audit_code(const std::filesystem::path& folder) {
  return run(tether({"audit", folder / "record.mcap"})).code;
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

void expect_same_runs(const std::filesystem::path& a, const std::filesystem::path& b) {
  EXPECT_EQ(timeless_result(a), timeless_result(b));
  const std::string record = timeless_record(a);
  EXPECT_GT(record.size(), 10'000u);
  EXPECT_TRUE(record == timeless_record(b)) << "the records differ";
}

void write_record(const std::filesystem::path& file, const record::Record& record) {
  std::map<std::uint64_t, std::function<void(record::Recorder&)>> writes;  // in the file's order
  const auto add = [&](const auto& messages) {
    for (const auto& logged : messages)
      writes[logged.order] = [&logged](auto& recorder) {
        recorder.write(logged.at, logged.message);
      };
  };
  add(record.interactions);
  add(record.commands);
  add(record.ground_truth);
  add(record.annotations);
  add(record.images);
  add(record.raw_images);
  const auto recorder = record::make_mcap_recorder(file);
  recorder->write(record.header);
  for (const auto& [order, write] : writes) write(*recorder);
  if (record.footer) recorder->write(*record.footer);
}

ExternalRun::ExternalRun(const std::filesystem::path& scenario, const std::filesystem::path& out,
                         const std::vector<std::string>& options) {
  tether_ = std::make_unique<Process>(
      with(tether({"run", scenario, "--force", "--out", out, "--target", "wait", "--quiet"}),
           options, {{"TETHER_TOKEN", kToken}}));

  const bool listens = tether_->wait_for_err(" TETHER_CLOCK=", std::chrono::seconds(90));
  const std::string text = tether_->err();
  if (!listens) throw std::runtime_error("tether does not listen: " + text);
  const auto value_of = [&text](const std::string& key) {
    const auto begin = text.find(key) + key.size();
    std::string value = text.substr(begin, text.find(' ', begin) - begin);
    std::erase(value, '\'');
    return value;
  };
  address_ = value_of("TETHER_ADDRESS=");
  clock_ = value_of("TETHER_CLOCK=");
}

std::string ExternalRun::token() {
  return kToken;
}

std::unique_ptr<Process> ExternalRun::start_sut(const std::vector<std::string>& arguments,
                                                const Variables& environment) const {
  const Variables joining{
      {"TETHER_ADDRESS", address_}, {"TETHER_TOKEN", kToken}, {"TETHER_CLOCK", clock_}};
  return std::make_unique<Process>(with({arguments, joining}, {}, environment));
}

SlowWire::SlowWire(const std::string& address, int delay_ms, int mbit_s)
    : proxy_({{proxy_program(), address, std::to_string(delay_ms), std::to_string(mbit_s)}}) {
  if (!proxy_.wait_for_out("\n", std::chrono::seconds(10))) throw std::runtime_error(proxy_.err());
  address_ = proxy_.out().substr(0, proxy_.out().find('\n'));
}

std::vector<std::string> face_sut() {
  return {
      sut_program(),      "face_anchor", "--anchor",        "blue_box", "--precision-deg",     "3",
      "--yaw-rate-deg-s", "25",          "--prefilter",     "median",   "--prefilter-size-px", "5",
      "--tolerance-px",   "4",           "--stable-frames", "2"};
}

}  // namespace tether::system_test
