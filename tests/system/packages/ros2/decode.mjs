// Decodes what the peer printed, with definitions of a release of ROS 2: decode.mjs RELEASE TYPES.json <LINES
// TYPES.json: the name of each topic's message, such as "sensor_msgs/Imu". Prints one JSON object, by topic:
// {count, first, last}. Arrays of numbers longer than 100 are their length and their first ten.
import { readFileSync } from "node:fs";
import releases from "@foxglove/rosmsg-msgs-common";
import { MessageReader } from "@foxglove/rosmsg2-serialization";

const definitions = releases[process.argv[2]];
const types = JSON.parse(readFileSync(process.argv[3], "utf8"));

/** A type, and all that it consists of. */
function closure(name, found = new Map()) {
  if (found.has(name)) return found;
  found.set(name, { ...definitions[name], name: found.size === 0 ? undefined : name });
  for (const field of definitions[name].definitions) if (field.isComplex) closure(field.type, found);
  return found;
}

const plain = (_, value) => {
  if (typeof value === "bigint") return Number(value);
  if (typeof value === "number" && !Number.isFinite(value)) return String(value);
  if (!ArrayBuffer.isView(value)) return value;
  const numbers = Array.from(value);
  return numbers.length > 100 ? { length: numbers.length, first: numbers.slice(0, 10) } : numbers;
};

const decoded = {};
for (const line of readFileSync(0, "utf8").trim().split("\n")) {
  const [topic, count, ...bytes] = line.split(" ");
  const reader = new MessageReader([...closure(types[topic]).values()]);
  const [first, last] = bytes.map((text) => (text === "" ? null : reader.readMessage(Buffer.from(text, "hex"))));
  decoded[topic] = { count: Number(count), first, last };
}
console.log(JSON.stringify(decoded, plain));
