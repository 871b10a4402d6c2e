// The other side of the exchange: node-mavlink, which shares no code with Tether.
//
//   node peer.mjs read FRAMES [PASSPHRASE]             one line for each frame, as exchange.cpp prints them
//   node peer.mjs write FRAMES NAMES [PASSPHRASE]      messages of the types whose names are in the file NAMES
//
// `read` also encodes each message again: the bytes must be those that were read. With a passphrase, each signature is
// checked or made.

import { readFileSync, writeFileSync } from "node:fs";
import { Readable } from "node:stream";

import mavlink from "node-mavlink";
const { MavLinkPacketSignature, MavLinkProtocolV1, MavLinkProtocolV2, ardupilotmega, common, createMavLinkStream, minimal, standard } = mavlink;

const TYPES = { ...minimal.REGISTRY, ...standard.REGISTRY, ...common.REGISTRY, ...ardupilotmega.REGISTRY };

function fail(what) {
  console.error(what);
  process.exit(1);
}

function floatBits(value) {
  const view = new DataView(new ArrayBuffer(4));
  view.setFloat32(0, value);
  return view.getUint32(0).toString(16).padStart(8, "0");
}

function line(type, message, { version, sysid, compid, seq, isSigned }) {
  const fields = type.FIELDS.map((field) => {
    const value = message[field.name];
    const text = (v) => (field.type.startsWith("float") ? floatBits(v) : String(v));
    const name = `${field.source}${field.extension ? "(extension)" : ""}`;
    if (field.type === "char[]") return `${name}="${value}"`;
    return `${name}=${field.length > 0 ? value.map(text).join(",") : text(value)}`;
  });
  return [`${type.MSG_ID} ${type.MSG_NAME} crc_extra=${type.MAGIC_NUMBER} length=${type.PAYLOAD_LENGTH} version=${version}`,
    `from=${sysid}.${compid} sequence=${seq} signed=${isSigned ? 1 : 0}`, ...fields].join(" ");
}

async function read(file, key) {
  const stream = createMavLinkStream(Readable.from([readFileSync(file)], { objectMode: false }), { onCrcError: () => fail("a wrong checksum") });
  for await (const packet of stream) {
    const type = TYPES[packet.header.msgid];
    const message = packet.protocol.data(packet.payload, type);
    const { sysid, compid, seq } = packet.header;
    if (key && !(packet.signature && packet.signature.matches(key))) fail(`${type.MSG_NAME}: not signed with this key`);
    const version = packet.protocol instanceof MavLinkProtocolV2 ? 2 : 1;
    console.log(line(type, message, { version, sysid, compid, seq, isSigned: packet.signature !== null }));
    // A payload of zeros alone keeps one byte (MAVLink's guide "Serialization"); node-mavlink leaves that one out too.
    const again = new MavLinkProtocolV2(sysid, compid, key ? MavLinkProtocolV2.IFLAG_SIGNED : 0).serialize(message, seq);
    const isZero = packet.header.payloadLength === 1 && packet.payload[0] === 0;
    if (!isZero && !again.equals(packet.buffer.subarray(0, again.length))) fail(`${type.MSG_NAME}: other bytes when it is encoded again`);
  }
}

// Numbers that are the same in each run.
let state = 1n;
function random(bits) {
  state = BigInt.asUintN(64, state * 6364136223846793005n + 1442695040888963407n);
  return BigInt.asUintN(bits, (state >> 32n) * (state >> 16n));
}

function value(type) {
  if (type === "float") return Math.fround((Number(random(30)) - 2 ** 29) * 2 ** (Number(random(6)) - 40));
  if (type === "char") return Number(random(7));
  const bits = Number(type.match(/\d+/)[0]);
  const number = type.startsWith("u") ? random(bits) : BigInt.asIntN(bits, random(bits));
  return bits === 64 ? number : Number(number);
}

// Of variant 0, all is zero; of the later ones, the fields from some place on.
function messageOf(type, variant) {
  const message = new type();
  const filled = variant === 0 ? 0 : variant < 3 ? type.FIELDS.length : Number(random(16)) % type.FIELDS.length;
  type.FIELDS.forEach((field, i) => {
    const element = field.type.replace("[]", "").replace("_mavlink_version", "");
    const zero = element.endsWith("64_t") ? 0n : 0;
    const next = () => (i < filled ? value(element) : zero);
    const text = () => Array.from({ length: i < filled ? Number(random(16)) % (field.length + 1) : 0 }, () => String.fromCharCode(33 + (Number(random(16)) % 90))).join("");
    message[field.name] = field.type === "char[]" ? text() : field.length > 0 ? Array.from({ length: field.length }, next) : next();
  });
  return message;
}

function write(file, names, key) {
  const types = Object.values(TYPES).filter((type) => names.has(type.MSG_NAME));
  const frames = [];
  let seq = 0;
  types.forEach((type) => {
    for (let variant = 0; variant < 6; ++variant, seq = (seq + 1) % 256) {
      const [sysid, compid] = [1 + (Number(random(16)) % 255), Number(random(8))];
      const message = messageOf(type, variant);
      const protocol = new MavLinkProtocolV2(sysid, compid, key ? MavLinkProtocolV2.IFLAG_SIGNED : 0);
      const frame = protocol.serialize(message, seq);
      // A millisecond, node-mavlink's smallest step, for each.
      frames.push(key ? protocol.sign(frame, 7, key, Date.UTC(2026, 0, 1) + frames.length) : frame);
      console.log(line(type, message, { version: 2, sysid, compid, seq, isSigned: Boolean(key) }));
      // In MAVLink 1 there are no extensions. node-mavlink writes them, so that only messages without them are sent.
      if (key || type.MSG_ID > 255 || type.FIELDS.some((field) => field.extension)) continue;
      frames.push(new MavLinkProtocolV1(sysid, compid).serialize(message, seq));
      console.log(line(type, message, { version: 1, sysid, compid, seq, isSigned: false }));
    }
  });
  writeFileSync(file, Buffer.concat(frames));
}

const [what, file, ...rest] = process.argv.slice(2);
const names = what === "write" ? new Set(readFileSync(rest.shift(), "utf8").split(/\s+/)) : undefined;
const key = rest.length > 0 ? MavLinkPacketSignature.key(rest[0]) : undefined;
if (what === "read") await read(file, key);
else if (what === "write") write(file, names, key);
else process.exit(2);
