#pragma once

#include "ros2.h"

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <dds/dds.h>

/// ROS 2's messages and topics on DDS (CycloneDDS), as far as the driver needs them.
namespace ros2 {

template <class Message>
const dds_topic_descriptor_t& type_of();

#define ROS2_MESSAGE(package, name)                      \
  using name = package##_msg_dds__##name##_;             \
  template <>                                            \
  inline const dds_topic_descriptor_t& type_of<name>() { \
    return package##_msg_dds__##name##__desc;            \
  }
ROS2_MESSAGE(geometry_msgs, PoseStamped)
ROS2_MESSAGE(geometry_msgs, Twist)
ROS2_MESSAGE(geometry_msgs, TwistStamped)
ROS2_MESSAGE(nav_msgs, Odometry)
ROS2_MESSAGE(sensor_msgs, CameraInfo)
ROS2_MESSAGE(sensor_msgs, FluidPressure)
ROS2_MESSAGE(sensor_msgs, Image)
ROS2_MESSAGE(sensor_msgs, Imu)
ROS2_MESSAGE(sensor_msgs, LaserScan)
ROS2_MESSAGE(sensor_msgs, MagneticField)
ROS2_MESSAGE(sensor_msgs, NavSatFix)
ROS2_MESSAGE(sensor_msgs, PointCloud2)
ROS2_MESSAGE(sensor_msgs, Range)
ROS2_MESSAGE(tf2_msgs, TFMessage)
#undef ROS2_MESSAGE
using Header = std_msgs_msg_dds__Header_;
using PointField = sensor_msgs_msg_dds__PointField_;
using TransformStamped = geometry_msgs_msg_dds__TransformStamped_;

[[noreturn]] inline void fail(const std::string& what) {
  std::fprintf(stderr, "ros2_driver: %s\n", what.c_str());
  std::exit(3);
}

inline dds_entity_t require(dds_entity_t made, const std::string& what) {
  if (made < 0) fail("cannot create " + what + ": " + dds_strretcode(-made));
  return made;
}

// Loopback interfaces mostly have no multicast. A large image must not fill a receiver's buffer
// with small packets before it runs.
constexpr const char* kThisMachine =
    "<General><Interfaces><NetworkInterface name=\"lo\" multicast=\"false\"/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast><MaxMessageSize>65500B</MaxMessageSize>"
    "<FragmentSize>65000B</FragmentSize></General>"
    "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
    "<MaxAutoParticipantIndex>30</MaxAutoParticipantIndex>"
    "<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery>";

/// In the domain of ROS_DOMAIN_ID (0). Unless CYCLONEDDS_URI says something else, it talks to
/// others on this machine, by unicast.
inline dds_entity_t make_participant() {
  const char* const id = std::getenv("ROS_DOMAIN_ID");
  const auto domain = static_cast<dds_domainid_t>(id == nullptr ? 0 : std::atoi(id));
  if (std::getenv("CYCLONEDDS_URI") == nullptr)
    require(dds_create_domain(domain, kThisMachine), "the domain");
  return require(dds_create_participant(domain, nullptr, nullptr), "a participant");
}

/// As ROS 2 has it by default: reliable, the newest ten. `is_latched`: also for who comes late.
inline dds_qos_t* make_qos(bool is_latched = false) {
  dds_qos_t* const qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 10);
  if (is_latched) dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  return qos;
}

template <class Message>
dds_entity_t make_topic(dds_entity_t participant, const std::string& name, dds_qos_t* qos) {
  const std::string topic = "rt/" + name;
  return require(dds_create_topic(participant, &type_of<Message>(), topic.c_str(), qos, nullptr),
                 topic);
}

/// Writes one topic. Thread-safe.
template <class Message>
class Publisher {
 public:
  Publisher(dds_entity_t participant, const std::string& name, bool is_latched = false) {
    dds_qos_t* const qos = make_qos(is_latched);
    const dds_entity_t topic = make_topic<Message>(participant, name, qos);
    writer_ = require(dds_create_writer(participant, topic, qos, nullptr), "a writer of " + name);
    dds_delete_qos(qos);
  }
  /// Whether somebody listens.
  bool is_wanted() const {
    dds_publication_matched_status_t matched{};
    return dds_get_publication_matched_status(writer_, &matched) == DDS_RETCODE_OK &&
           matched.current_count > 0;
  }
  /// What the message points to is copied.
  void publish(const Message& message) const { dds_write(writer_, &message); }

 private:
  dds_entity_t writer_;
};

template <class Message>
dds_entity_t make_reader(dds_entity_t participant, const std::string& name) {
  dds_qos_t* const qos = make_qos();
  const dds_entity_t topic = make_topic<Message>(participant, name, qos);
  const dds_entity_t reader =
      require(dds_create_reader(participant, topic, qos, nullptr), "a reader of " + name);
  dds_delete_qos(qos);
  return reader;
}

/// Calls `act` with each message that has come.
template <class Message, class Act>
void take(dds_entity_t reader, Act act) {
  void* message = nullptr;
  for (dds_sample_info_t info{}; dds_take(reader, &message, &info, 1, 1) > 0; message = nullptr) {
    if (info.valid_data) act(*static_cast<const Message*>(message));
    dds_return_loan(reader, &message, 1);
  }
}

/// What messages point to, and do not own.
/// @{
template <class Sequence>
void lend(Sequence& sequence, const void* items, std::size_t count) {
  sequence._buffer = static_cast<decltype(sequence._buffer)>(const_cast<void*>(items));
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(count);
}
template <class Sequence, class Item>
void lend(Sequence& sequence, const std::vector<Item>& items) {
  lend(sequence, items.data(), items.size());
}
inline char* lend(const std::string& text) {
  return const_cast<char*>(text.c_str());
}
/// @}

}  // namespace ros2
