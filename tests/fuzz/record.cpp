#include "fuzz_target.h"
#include "mcap_mutator.h"

#include <sstream>
#include <string>

#include <tether/audit/audit.h>
#include <tether/record/reader.h>
#include <tether/record/writer.h>
#include <tether/record_testing/canonical.h>

/// Records: reader, audit, and writing again what was read. Input: the file. CRCs that are 0 are
/// not checked, and chunks need not be compressed, so that most seeds are of that kind.
namespace tether::fuzz {
namespace {

constexpr record::CanonicalOptions kAll{.arrivals = true};

void write(const record::Record& record, const std::filesystem::path& file) {
  const auto recorder = record::make_mcap_recorder(file);
  recorder->write(record.header);
  const auto write_all = [&](const auto& messages) {
    for (const auto& logged : messages) recorder->write(logged.at, logged.message);
  };
  write_all(record.interactions);
  write_all(record.commands);
  write_all(record.ground_truth);
  write_all(record.annotations);
  write_all(record.stops);
  write_all(record.images);
  write_all(record.raw_images);
  if (record.footer) recorder->write(*record.footer);
}

/// What was read says the same when it is written and read again; the audit takes either.
void require_same_again(const record::Record& record, const std::filesystem::path& file) {
  write(record, file);
  const record::Record again = record::read_record(file, {.images = true});
  // Without its end it counts as torn there.
  require(again.damage.empty() || !record.footer, "a record of ours is damaged: " + again.damage);
  require(record::canonical(record, kAll) == record::canonical(again, kAll),
          "a record that says something else once written");
  require(record.header.suts.size() == again.header.suts.size() &&
              record.header.sensors.size() == again.header.sensors.size() &&
              record.header.anchors.size() == again.header.anchors.size(),
          "a header that says something else once written");
  require(record.footer.has_value() == again.footer.has_value(), "the end is lost");
}

void judge(const record::Record& record) {
  const audit::Verdict verdict = audit::audit(record);
  require(verdict.findings.size() <= audit::kMaxFindings, "too many findings");
  for (const audit::Finding& finding : verdict.findings) require_one_line(finding.what);
  const std::string text = audit::to_text(verdict);
  require(!text.empty(), "a verdict without words");
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) require_one_line(line);
}

}  // namespace
}  // namespace tether::fuzz

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
  return tether::fuzz::mutate_mcap(data, size, max_size, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  static const fuzz::InputFolder folder;
  const auto file = folder.write("input.mcap", fuzz::Bytes{data, size});
  const auto read =
      fuzz::read_or_refuse([&] { return record::read_record(file, {.images = true}); });
  if (!read) return 0;
  if (!read->damage.empty()) fuzz::require_one_line(read->damage);
  fuzz::judge(*read);
  fuzz::require_same_again(*read, folder.path() / "again.mcap");
  return 0;
}
