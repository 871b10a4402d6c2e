#!/usr/bin/env node
// A companion computer's program in Node: uploads a mission by MAVLink (npm: node-mavlink), starts it,
// and waits until the vehicle has landed. Nothing of Tether is in it.
//
// usage: node mission.cjs [SIDE_M [HEIGHT_M]]
'use strict';
const dgram = require('dgram');
const { PassThrough } = require('stream');
const { MavLinkPacketSplitter, MavLinkPacketParser, MavLinkProtocolV2, common, minimal } =
    require('node-mavlink');

const side = Number(process.argv[2] ?? 4), height = Number(process.argv[3] ?? 2);
const registry = { ...minimal.REGISTRY, ...common.REGISTRY };
const protocol = new MavLinkProtocolV2(1, 191);
const link = dgram.createSocket('udp4');
const stream = new PassThrough();
const reader = stream.pipe(new MavLinkPacketSplitter()).pipe(new MavLinkPacketParser());
let address = null, sequence = 0, items = [], isArmed = false, hasFlown = false;

function send(message, fields) {
  Object.assign(message, fields);
  link.send(protocol.serialize(message, sequence++ & 255), address.port, address.address);
}

function command(id, p1 = 0) {
  send(new common.CommandLong(), {
    targetSystem: 1, targetComponent: 1, command: id, confirmation: 0,
    _param1: p1, _param2: 0, _param3: 0, _param4: 0, _param5: 0, _param6: 0, _param7: 0,
  });
}

// North and east of home, in degrees.
function place(home, north, east) {
  const metres = 111319.5;
  return [
    Math.round(home.latitude + north / metres * 1e7),
    Math.round(home.longitude + east / (metres * Math.cos(home.latitude * 1e-7 * Math.PI / 180)) * 1e7),
  ];
}

function plan(home) {
  const corners = [[side, 0], [side, side], [0, side], [0, 0]];
  const TAKEOFF = 22, WAYPOINT = 16, LAND = 21;
  return [
    [TAKEOFF, ...place(home, 0, 0), height, 0],
    ...corners.map(([n, e]) => [WAYPOINT, ...place(home, n, e), height, 0.5]),
    [LAND, ...place(home, 0, 0), 0, 0],
  ];
}

const on = {
  Heartbeat(m) {
    const armed = (m.baseMode & 128) !== 0;
    if (isArmed && !armed && hasFlown) {
      console.log('landed after', (performance.now() / 1000).toFixed(2), 's');
      process.exit(0);
    }
    isArmed = armed;
  },
  HomePosition(m) {
    if (items.length > 0) return;
    items = plan(m);
    send(new common.MissionCount(), { targetSystem: 1, targetComponent: 1, count: items.length });
  },
  MissionRequestInt(m) {
    const [id, x, y, z, radius] = items[m.seq];
    send(new common.MissionItemInt(), {
      targetSystem: 1, targetComponent: 1, seq: m.seq, frame: 6, command: id, current: 0,
      autocontinue: 1, param1: 0.2, param2: radius, param3: 0, param4: NaN, x, y, z,
    });
  },
  MissionAck(m) {
    console.log('mission', m.type === 0 ? 'accepted' : `refused: ${m.type}`);
    if (m.type !== 0) process.exit(1);
    command(400, 1);  // arm
    command(300);     // start
  },
  MissionItemReached(m) {
    console.log('reached', m.seq);
    hasFlown = true;
  },
  StatusText(m) { console.log(m.text); },
};

reader.on('data', (packet) => {
  const type = registry[packet.header.msgid];
  if (type && on[type.name]) on[type.name](packet.protocol.data(packet.payload, type));
});
link.on('message', (data, from) => {
  address = from;
  stream.write(data);
});
link.bind(14540);
setInterval(() => {
  if (address)
    send(new minimal.Heartbeat(), { type: 18, autopilot: 8, baseMode: 0, customMode: 0, systemStatus: 4 });
}, 1000);
