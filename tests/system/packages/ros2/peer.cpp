// The other side of the ROS 2 driver: Fast DDS, which shares no code with it, and knows no types.
// peer SECONDS TOPIC TYPE [TOPIC TYPE ...]: prints the bytes of the first and last message of each
// topic ("TOPIC COUNT FIRST LAST", in hexadecimal digits), and sends velocities: up, 0.5 m/s.
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

namespace {

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using Bytes = std::vector<unsigned char>;

/// A type by its name: its messages are bytes, the four of their encapsulation included.
class AnyType final : public fast::TopicDataType {
 public:
  explicit AnyType(const std::string& name) {
    constexpr std::uint32_t kMostBytes = 4'000'000;
    setName(name.c_str());
    m_typeSize = kMostBytes;
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const Bytes& bytes = *static_cast<Bytes*>(data);
    payload->encapsulation = CDR_LE;
    payload->length = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(payload->data, bytes.data(), bytes.size());
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<Bytes*>(data)->assign(payload->data, payload->data + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<Bytes*>(data)->size()); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

/// On this machine's loopback alone, as with ROS_LOCALHOST_ONLY; the driver has to find it.
fast::DomainParticipant* make_participant() {
  fast::DomainParticipantQos qos;
  const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.emplace_back("127.0.0.1");
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  return fast::DomainParticipantFactory::get_instance()->create_participant(0, qos);
}

fast::Topic* make_topic(fast::DomainParticipant* participant, const std::string& name,
                        const std::string& type) {
  fast::TypeSupport(new AnyType(type)).register_type(participant);
  return participant->create_topic("rt/" + name, type, fast::TOPIC_QOS_DEFAULT);
}

struct Heard {
  std::string topic;
  fast::DataReader* reader;
  int count = 0;
  Bytes first{}, last{};

  void take() {
    Bytes bytes;
    fast::SampleInfo info;
    while (reader->take_next_sample(&bytes, &info) ==
           eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      if (count++ == 0) first = bytes;
      last = std::move(bytes);
    }
  }
};

std::string hexadecimal(const Bytes& bytes) {
  std::string text;
  for (const unsigned char byte : bytes) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", byte);
    text += digits;
  }
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  fast::DomainParticipant* const participant = make_participant();
  fast::Subscriber* const subscriber = participant->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
  std::vector<Heard> all;
  for (int i = 2; i + 1 < argc; i += 2) {
    fast::DataReaderQos qos;
    qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
    qos.history().depth = 10;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    if (std::string(argv[i]) == "tf_static")
      qos.durability().kind = fast::TRANSIENT_LOCAL_DURABILITY_QOS;
    fast::Topic* const topic = make_topic(participant, argv[i], argv[i + 1]);
    all.push_back({argv[i], subscriber->create_datareader(topic, qos)});
  }
  fast::DataWriter* const commands =
      participant->create_publisher(fast::PUBLISHER_QOS_DEFAULT)
          ->create_datawriter(
              make_topic(participant, "cmd_vel", "geometry_msgs::msg::dds_::Twist_"),
              fast::DATAWRITER_QOS_DEFAULT);
  const double twist[] = {0.0, 0.0, 0.5, 0.0, 0.0, 0.0};
  Bytes command = {0, 1, 0, 0};
  command.resize(4 + sizeof twist);
  std::memcpy(command.data() + 4, twist, sizeof twist);

  constexpr auto kPeriod = std::chrono::milliseconds(50);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(std::atoi(argv[1]));
  while (std::chrono::steady_clock::now() < end) {
    commands->write(&command);
    std::this_thread::sleep_for(kPeriod);
    for (Heard& heard : all) heard.take();
  }
  for (const Heard& heard : all)
    std::printf("%s %d %s %s\n", heard.topic.c_str(), heard.count, hexadecimal(heard.first).c_str(),
                hexadecimal(heard.last).c_str());
  std::fflush(stdout);
  std::_Exit(0);
}
