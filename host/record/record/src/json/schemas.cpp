// The JSON schemas of the record's topics, as they are written into each file: ours, then
// Foxglove's.

#include "json/schemas.h"

namespace tether::record {

const Schema kInteractionSchema{"tether.Interaction", R"json({
  "title": "tether.Interaction",
  "description": "One request of a SUT and its reply. Log time: ST at release.",
  "type": "object",
  "properties": {
    "uav": {"type": "string"},
    "sequence": {"type": "integer", "minimum": 1},
    "kind": {"type": "string", "enum": ["sensor", "command", "sleep", "finish", "send", "receive",
                                      "battery"]},
    "request_at_ns": {"type": "integer", "description": "ET when the request was issued"},
    "reply_at_ns": {"type": "integer", "description": "ET with which the SUT goes on"},
    "sensor": {"type": "string"},
    "sample_index": {"type": "integer", "minimum": 0},
    "latest": {"type": "boolean", "description": "the last measurement was asked for, new or not"},
    "only_if_available": {"type": "boolean", "description": "what was there was asked for, at once"},
    "sampled_at_ns": {"type": "integer", "description": "ST that the timing model asked for"},
    "sample_state_at_ns": {"type": "integer", "description": "ST of the state that was measured"},
    "available_at_ns": {"type": "integer", "description": "sampled_at + delay"},
    "sample_stamp_ns": {"type": "integer", "description": "time of the sample that the SUT saw"},
    "repeated_index": {"type": "integer", "minimum": 0,
                       "description": "the content is that of this earlier measurement"},
    "skipped_to": {"type": "integer", "minimum": 0,
                   "description": "the last measurement that counts as read without being read"},
    "seen_anchors": {
      "type": "array",
      "description": "of an image: each anchor of which pixels are visible",
      "items": {
        "type": "object",
        "properties": {
          "anchor": {"type": "string"},
          "left_px": {"type": "integer"},
          "top_px": {"type": "integer"},
          "right_px": {"type": "integer"},
          "bottom_px": {"type": "integer"},
          "pixels": {"type": "integer", "description": "how many are visible"}
        },
        "required": ["anchor", "left_px", "top_px", "right_px", "bottom_px", "pixels"]
      }
    },
    "effect_at_ns": {"type": "integer", "description": "first step boundary the command acts on"},
    "command": {
      "type": "object",
      "description": "the velocity that was asked for, in the heading frame H",
      "properties": {
        "vx_H_m_s": {"type": "number"},
        "vy_H_m_s": {"type": "number"},
        "vz_H_m_s": {"type": "number"},
        "yaw_rate_rad_s": {"type": "number"}
      },
      "required": ["vx_H_m_s", "vy_H_m_s", "vz_H_m_s", "yaw_rate_rad_s"]
    },
    "setpoints": {
      "type": "array",
      "description": "what was asked for, if it is not one velocity in the heading frame",
      "items": {
        "type": "object",
        "properties": {
        "mask": {"type": "integer", "description": "sum of: 1 position, 2 velocity, 4 acceleration, 8 yaw, 16 yaw rate, 32 attitude, 64 body rates, 128 thrust, 256 rotor speeds, 512 joints"},
        "after_ns": {"type": "integer", "description": "from when the command arrives"},
        "in_heading": {"type": "boolean", "description": "velocity and acceleration are in H, not W"},
        "p_WB_m": {"type": "array", "items": {"type": "number"}},
        "velocity_m_s": {"type": "array", "items": {"type": "number"}},
        "acceleration_m_s2": {"type": "array", "items": {"type": "number"}},
        "yaw_rad": {"type": "number"},
        "yaw_rate_rad_s": {"type": "number"},
        "q_WB": {"type": "array", "items": {"type": "number"}, "description": "w, x, y, z"},
        "w_WB_B_rad_s": {"type": "array", "items": {"type": "number"}},
        "thrust_n": {"type": "number"},
        "rotor_speeds_rad_s": {"type": "array", "items": {"type": "number"}},
        "joints_rad": {"type": "array", "items": {"type": "number"}}
        },
        "required": ["mask"]
      }
    },
    "command_latency_ns": {"type": "integer", "description": "until it arrived, if not constant"},
    "sleep_until_ns": {"type": "integer", "description": "ET at which the SUT asked to be woken"},
    "receive_until_ns": {"type": "integer", "description": "ET of the request + timeout; less, if it also waited for a measurement"},
    "received": {
      "type": "object",
      "description": "the message that was received",
      "properties": {
        "from": {"type": "string", "description": "the sender's UAV"},
        "sequence": {"type": "integer", "description": "of the sender's call"},
        "arrived_at_ns": {"type": "integer"}
      },
      "required": ["from", "sequence", "arrived_at_ns"]
    },
    "received_more": {"type": "integer", "description": "messages of the flight controller that came next, and were received with it"},
    "battery": {
      "type": "object",
      "description": "what was read of the battery, at st_at_release",
      "properties": {
        "voltage_v": {"type": "number", "description": "at the terminals"},
        "current_a": {"type": "number"},
        "charge": {"type": "number", "description": "share of the capacity"}
      },
      "required": ["voltage_v", "current_a", "charge"]
    },
    "st_at_arrival_ns": {"type": "integer"},
    "lag_ns": {"type": "integer", "description": "request_at - st_at_arrival"},
    "st_at_release_ns": {"type": "integer"},
    "grid_error_ns": {"type": "integer", "description": "what the step grid moved"},
    "stamped": {"type": "boolean", "description": "request_at was taken on the SUT's side"},
    "violation": {"type": "string", "description": "causality violation"},
    "stages": {
      "type": "array",
      "description": "what was computed since the previous call, by stage",
      "items": {
        "type": "object",
        "properties": {
          "stage": {"type": "string"},
          "computing_ns": {"type": "integer"},
          "unknown": {"type": "boolean", "description": "not in the timing file"}
        },
        "required": ["stage", "computing_ns"]
      }
    },
    "computed_ns": {
      "type": "integer",
      "description": "on a shared board: what was computed since the previous call"
    },
    "wall": {
      "type": "object",
      "description": "host clock; differs from run to run",
      "properties": {
        "arrival_ns": {"type": "integer"},
        "release_ns": {"type": "integer"},
        "previous_link_ns": {"type": "integer"}
      },
      "required": ["arrival_ns", "release_ns"]
    }
  },
  "required": ["uav", "sequence", "kind", "request_at_ns", "reply_at_ns", "st_at_arrival_ns",
               "lag_ns", "st_at_release_ns", "grid_error_ns", "stamped", "wall"]
})json"};

const Schema kCommandEffectSchema{"tether.CommandEffect", R"json({
  "title": "tether.CommandEffect",
  "description": "A set-point taking effect: a velocity in the heading frame H, or any other.",
  "type": "object",
  "properties": {
    "uav": {"type": "string"},
    "sequence": {"type": "integer", "minimum": 1, "description": "of its interaction"},
    "applied_at_ns": {"type": "integer"},
    "vx_H_m_s": {"type": "number"},
    "vy_H_m_s": {"type": "number"},
    "vz_H_m_s": {"type": "number"},
    "yaw_rate_rad_s": {"type": "number"},
    "setpoint": {
      "type": "object",
      "properties": {
        "mask": {"type": "integer", "description": "sum of: 1 position, 2 velocity, 4 acceleration, 8 yaw, 16 yaw rate, 32 attitude, 64 body rates, 128 thrust, 256 rotor speeds, 512 joints"},
        "after_ns": {"type": "integer", "description": "from when the command arrives"},
        "in_heading": {"type": "boolean", "description": "velocity and acceleration are in H, not W"},
        "p_WB_m": {"type": "array", "items": {"type": "number"}},
        "velocity_m_s": {"type": "array", "items": {"type": "number"}},
        "acceleration_m_s2": {"type": "array", "items": {"type": "number"}},
        "yaw_rad": {"type": "number"},
        "yaw_rate_rad_s": {"type": "number"},
        "q_WB": {"type": "array", "items": {"type": "number"}, "description": "w, x, y, z"},
        "w_WB_B_rad_s": {"type": "array", "items": {"type": "number"}},
        "thrust_n": {"type": "number"},
        "rotor_speeds_rad_s": {"type": "array", "items": {"type": "number"}},
        "joints_rad": {"type": "array", "items": {"type": "number"}}
      },
      "required": ["mask"]
    },
    "index": {"type": "integer", "description": "of the set-point in its command"},
    "loss": {"type": "string", "description": "no command has arrived for too long: what is done"}
  },
  "required": ["uav", "sequence", "applied_at_ns"]
})json"};

const Schema kGroundTruthSchema{"tether.GroundTruth", R"json({
  "title": "tether.GroundTruth",
  "description": "State of the UAV's body B in the world frame W (ENU).",
  "type": "object",
  "properties": {
    "uav": {"type": "string"},
    "at_ns": {"type": "integer"},
    "p_WB_m": {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3},
    "q_WB": {"type": "array", "items": {"type": "number"}, "minItems": 4, "maxItems": 4,
             "description": "w x y z"},
    "v_WB_m_s": {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3},
    "w_WB_B_rad_s": {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3},
    "clearance_m": {"type": "number", "description": "distance to the nearest surface"},
    "joints_rad": {"type": "array", "items": {"type": "number"}, "description": "angles of the UAV's joints"}
  },
  "required": ["uav", "at_ns", "p_WB_m", "q_WB", "v_WB_m_s", "w_WB_B_rad_s"]
})json"};

const Schema kAnnotationSchema{"tether.Annotation", R"json({
  "title": "tether.Annotation",
  "description": "What the SUT had to say. Log time: ST when it arrived.",
  "type": "object",
  "properties": {
    "uav": {"type": "string"},
    "at_ns": {"type": "integer", "description": "ET"},
    "topic": {"type": "string"},
    "data": {"type": "object", "properties": {}}
  },
  "required": ["uav", "at_ns", "topic", "data"]
})json"};

const Schema kStopSchema{"tether.Stop", R"json({
  "title": "tether.Stop",
  "description": "All threads of a concurrent SUT were stopped. Log time: ST when this was known.",
  "type": "object",
  "properties": {
    "uav": {"type": "string"},
    "at_ns": {"type": "integer", "description": "ET from which on, and with which it goes on"},
    "reply_at_ns": {"type": "integer", "description": "ET of the earliest reply due by then"},
    "wall": {
      "type": "object",
      "description": "host clock; differs from run to run",
      "properties": {
        "arrival_ns": {"type": "integer"}
      },
      "required": ["arrival_ns"]
    }
  },
  "required": ["uav", "at_ns", "wall"]
})json"};

const Schema kContactSchema{"tether.Contact", R"json({
  "title": "tether.Contact",
  "description": "A UAV began to touch something. Log time: ST of the next ground truth.",
  "type": "object",
  "properties": {
    "uav": {"type": "string"},
    "at_ns": {"type": "integer", "description": "ST at which both touched for the first time"},
    "with": {"type": "string", "description": "name of the model or UAV"},
    "speed_m_s": {"type": "number",
                  "description": "of approach along the contact's normal, before the impact"}
  },
  "required": ["uav", "at_ns", "with", "speed_m_s"]
})json"};

const Schema kRadioMessageSchema{"tether.RadioMessage", R"json({
  "title": "tether.RadioMessage",
  "description": "What became of a message between two UAVs. Log time: ST at at_ns.",
  "type": "object",
  "properties": {
    "uav": {"type": "string", "description": "of the sender"},
    "sequence": {"type": "integer", "minimum": 1, "description": "of the sender's call"},
    "to": {"type": "string", "description": "the receiver's UAV"},
    "bytes": {"type": "integer", "minimum": 0},
    "sent_at_ns": {"type": "integer", "description": "ET of the sender's call"},
    "at_ns": {"type": "integer", "description": "when it arrived, was lost, or the run ended"},
    "outcome": {"type": "string", "enum": ["delivered", "noise", "collision", "half_duplex",
                                           "queue_full", "too_long", "inbox_full", "waiting", "dropped"]},
    "began_at_ns": {"type": "integer", "description": "ST at which the transmission began"},
    "distance_m": {"type": "number"},
    "walls": {"type": "integer", "minimum": 0, "description": "between the UAVs"},
    "snr_db": {"type": "number", "description": "signal to noise and interference"}
  },
  "required": ["uav", "sequence", "to", "bytes", "sent_at_ns", "at_ns", "outcome"]
})json"};

const Schema kAutopilotMessageSchema{"tether.AutopilotMessage", R"json({
  "title": "tether.AutopilotMessage",
  "description": "A message between a flight controller and its SUT. Log time: ST when it was taken.",
  "type": "object",
  "properties": {
    "uav": {"type": "string"},
    "to_controller": {"type": "boolean"},
    "of_station": {"type": "boolean", "description": "from a ground station to the controller"},
    "sequence": {"type": "integer", "minimum": 1},
    "part": {"type": "integer", "minimum": 0, "description": "of several that were sent as one"},
    "bytes": {"type": "integer", "minimum": 0, "description": "of all that was sent as one"},
    "sent_at_ns": {"type": "integer", "description": "ET of the SUT, or ST of the controller"},
    "at_ns": {"type": "integer", "description": "when it arrived, or was lost"},
    "acted_at_ns": {"type": "integer", "description": "step of the controller that took it"},
    "outcome": {"type": "string", "enum": ["delivered", "queue_full", "inbox_full", "waiting", "not_signed",
                                           "wrong_signature", "old_signature", "ignored"]},
    "name": {"type": "string", "description": "of the MAVLink message; empty: not known"},
    "fields": {"type": "object", "description": "in the units of the MAVLink message"}
  },
  "required": ["uav", "sequence", "bytes", "sent_at_ns", "at_ns", "outcome", "name", "fields"]
})json"};

const Schema kBatterySchema{"tether.Battery", R"json({
  "title": "tether.Battery",
  "description": "The battery of a UAV, and the energy spent since ST 0, by cause.",
  "type": "object",
  "properties": {
    "uav": {"type": "string"},
    "at_ns": {"type": "integer"},
    "voltage_v": {"type": "number", "description": "at the terminals"},
    "current_a": {"type": "number"},
    "charge": {"type": "number", "description": "share of the capacity"},
    "lift_j": {"type": "number", "description": "what hovering takes"},
    "moving_j": {"type": "number", "description": "the rotors beyond that"},
    "idle_j": {"type": "number", "description": "the computer, idle"},
    "computing_j": {"type": "number", "description": "the computer's busy cores"},
    "sensors_j": {"type": "number", "description": "sensors and radio"},
    "resistance_j": {"type": "number", "description": "heat of the battery"}
  },
  "required": ["uav", "at_ns", "voltage_v", "current_a", "charge", "lift_j", "moving_j", "idle_j",
               "computing_j", "sensors_j", "resistance_j"]
})json"};

const Schema kMarginSchema{"tether.Margin", R"json({
  "title": "tether.Margin",
  "description": "The margin of a clause as it stood at an instant.",
  "type": "object",
  "properties": {
    "uav": {"type": "string"},
    "clause": {"type": "string"},
    "at_ns": {"type": "integer"},
    "margin": {"type": "number", "description": "negative: missed"},
    "unit": {"type": "string"}
  },
  "required": ["uav", "clause", "at_ns", "margin", "unit"]
})json"};

const Schema kCompressedImageSchema{"foxglove.CompressedImage", R"json({
  "title": "foxglove.CompressedImage",
  "type": "object",
  "properties": {
    "timestamp": {
      "type": "object", "title": "time",
      "properties": {
        "sec": {"type": "integer", "minimum": 0},
        "nsec": {"type": "integer", "minimum": 0, "maximum": 999999999}
      }
    },
    "frame_id": {"type": "string"},
    "format": {"type": "string"},
    "uav": {"type": "string"},
    "sensor": {"type": "string"},
    "index": {"type": "integer", "minimum": 0, "description": "which measurement of the sensor"},
    "data": {"type": "string", "contentEncoding": "base64"}
  },
  "required": ["timestamp", "frame_id", "format", "uav", "sensor", "index", "data"]
})json"};

const Schema kRawImageSchema{"foxglove.RawImage", R"json({
  "title": "foxglove.RawImage",
  "description": "Depths in metres (32FC1) or numbers of models (16UC1).",
  "type": "object",
  "properties": {
    "timestamp": {
      "type": "object", "title": "time",
      "properties": {
        "sec": {"type": "integer", "minimum": 0},
        "nsec": {"type": "integer", "minimum": 0, "maximum": 999999999}
      }
    },
    "frame_id": {"type": "string"},
    "width": {"type": "integer", "minimum": 1},
    "height": {"type": "integer", "minimum": 1},
    "uav": {"type": "string"},
    "sensor": {"type": "string"},
    "index": {"type": "integer", "minimum": 0, "description": "which measurement of the sensor"},
    "encoding": {"type": "string", "enum": ["32FC1", "16UC1"]},
    "step": {"type": "integer", "minimum": 0},
    "data": {"type": "string", "contentEncoding": "base64"}
  },
  "required": ["timestamp", "frame_id", "width", "height", "uav", "sensor", "index", "encoding",
               "step", "data"]
})json"};

const Schema kFrameTransformSchema{"foxglove.FrameTransform", R"json({
  "title": "foxglove.FrameTransform",
  "type": "object",
  "properties": {
    "timestamp": {
      "type": "object", "title": "time",
      "properties": {
        "sec": {"type": "integer", "minimum": 0},
        "nsec": {"type": "integer", "minimum": 0, "maximum": 999999999}
      }
    },
    "parent_frame_id": {"type": "string"},
    "child_frame_id": {"type": "string"},
    "translation": {
      "type": "object", "title": "foxglove.Vector3",
      "properties": {
        "x": {"type": "number"}, "y": {"type": "number"}, "z": {"type": "number"}
      }
    },
    "rotation": {
      "type": "object", "title": "foxglove.Quaternion",
      "properties": {
        "x": {"type": "number"}, "y": {"type": "number"}, "z": {"type": "number"},
        "w": {"type": "number"}
      }
    }
  },
  "required": ["timestamp", "parent_frame_id", "child_frame_id", "translation", "rotation"]
})json"};

}  // namespace tether::record
