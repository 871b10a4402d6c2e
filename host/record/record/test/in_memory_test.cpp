#include "json/json_metadata.h"
#include "sample_messages.h"

#include <limits>

#include <gtest/gtest.h>

#include <tether/record/writer.h>
#include <tether/record_testing/canonical.h>

namespace tether::record {
namespace {

/// Texts that are no UTF-8, numbers that are not finite, and JSON that is none.
void write_awkward_messages(Recorder& recorder) {
  GroundTruth nowhere = ground_truth();
  nowhere.p_WB_m[0] = std::numeric_limits<double>::infinity();
  nowhere.p_WB_m[1] = -0.0;
  nowhere.clearance_m = std::numeric_limits<double>::quiet_NaN();
  recorder.write(st_ms(60), nowhere);
  Interaction odd = command_interaction();
  odd.uav = "\xFF";
  odd.violation = "\xC3(";
  odd.stages = {{"\xE2\x82", Duration(3), true}};
  odd.received = ReceivedMessage{"\x80", 1, st_ms(1)};
  recorder.write(st_ms(60), odd);
  for (const char* json : {"no JSON", "{\"a\": \"\xFF\"}", "{ \"b\" : 1.50, \"a\" : [] }", ""}) {
    Annotation note = annotation();
    note.json = json;
    recorder.write(st_ms(60), note);
  }
  RadioMessage lost;
  lost.uav = "a";
  lost.to = "\xFF";
  recorder.write(st_ms(61), lost);
}

TEST(RecordInMemory, IsTheRecordThatIsReadFromTheFile) {
  const TemporaryFile file;
  RecordInMemory memory;
  {
    const auto mcap = make_mcap_recorder(file.path());
    FanOut both({mcap.get(), &memory});
    write_messages(both);
    write_awkward_messages(both);
    both.write(footer());
  }
  Record read = read_record(file.path());
  read.footer.value().topics.clear();
  const Record kept = memory.take();
  EXPECT_EQ(canonical(kept, {.arrivals = true}), canonical(read, {.arrivals = true}));
  EXPECT_EQ(to_metadata(kept.header), to_metadata(read.header));
  EXPECT_EQ(to_metadata(kept.footer.value()), to_metadata(*read.footer));
  EXPECT_EQ(kept.ground_truth.back().order, read.ground_truth.back().order) << "images count";
  EXPECT_EQ(kept.annotations[1].message.json, read.annotations[1].message.json);
  EXPECT_EQ(kept.interactions[0].message.wall_at_arrival,
            read.interactions[0].message.wall_at_arrival);
  EXPECT_TRUE(kept.unloaded.empty() && kept.images.empty());
}

TEST(RecordInMemory, HasWhatAControllerSaysOfItsState) {
  RecordInMemory memory;
  for (const char* name : {"COMMAND_ACK", "ATTITUDE"}) {
    AutopilotMessage message;
    message.name = name;
    message.fields = R"({"result": 2})";
    memory.write(st_ms(1), message);
  }
  const Record kept = memory.take();
  EXPECT_EQ(kept.autopilot.at(0).message.fields, R"({"result": 2})");
  EXPECT_EQ(kept.autopilot.at(1).message.fields, "{}");
}

}  // namespace
}  // namespace tether::record
