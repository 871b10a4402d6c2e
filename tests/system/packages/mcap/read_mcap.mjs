// Reads a record of Tether's with MCAP's own reader and checks it from outside:
//
//   node read_mcap.mjs [--partial] RECORD
//
// Every message is read twice, through the index and front to back with all CRCs checked; both must agree, with each
// other and with the statistics. Every message must be valid under its channel's JSON schema. Prints a JSON summary;
// exit 0 if nothing is wrong, 1 if something is (listed under "problems"), 2 on wrong use.
// --partial: of a run that was cut short. There is no index then; what is there must be sound all the same.

import { open, readFile } from "node:fs/promises";

import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import * as fzstd from "fzstd";

import { schemaErrors } from "./json_schema.mjs";

const decompressHandlers = {
  zstd: (packed, size) => fzstd.decompress(packed, new Uint8Array(Number(size))),
};

class FileReadable {
  constructor(handle) {
    this.handle = handle;
  }
  async size() {
    return BigInt((await this.handle.stat()).size);
  }
  async read(offset, length) {
    const bytes = new Uint8Array(Number(length));
    const { bytesRead } = await this.handle.read(bytes, 0, bytes.length, Number(offset));
    if (bytesRead !== bytes.length) throw new Error(`read ${bytesRead} of ${length} bytes at ${offset}`);
    return bytes;
  }
}

// Counts messages per topic and checks each against its schema.
class Topics {
  constructor(problems) {
    this.problems = problems;
    this.schemas = new Map();
    this.channels = new Map();
    this.topics = {};
  }

  addSchema(schema) {
    const text = new TextDecoder("utf-8", { fatal: true }).decode(schema.data);
    this.schemas.set(schema.id, { name: schema.name, encoding: schema.encoding, json: JSON.parse(text) });
  }

  addChannel(channel) {
    this.channels.set(channel.id, channel);
    if (channel.messageEncoding !== "json") this.problems.push(`${channel.topic}: encoded as ${channel.messageEncoding}`);
  }

  addMessage(message) {
    const channel = this.channels.get(message.channelId);
    const schema = this.schemas.get(channel.schemaId);
    const topic = (this.topics[channel.topic] ??= {
      schema: schema?.name,
      schema_encoding: schema?.encoding,
      messages: 0,
      first_ns: Number(message.logTime),
      last_ns: Number(message.logTime),
    });
    if (message.sequence !== topic.messages) this.problems.push(`${channel.topic}: message ${message.sequence} is number ${topic.messages}`);
    ++topic.messages;
    topic.last_ns = Number(message.logTime);
    if (message.publishTime !== message.logTime) this.problems.push(`${channel.topic}: published at another time than logged`);
    const value = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(message.data));
    for (const error of schema ? schemaErrors(schema.json, value) : ["no schema"]) {
      this.problems.push(`${channel.topic} #${message.sequence}: ${error}`);
    }
  }
}

async function readThroughIndex(file, problems) {
  const handle = await open(file, "r");
  try {
    const reader = await McapIndexedReader.Initialize({ readable: new FileReadable(handle), decompressHandlers });
    const topics = new Topics(problems);
    for (const schema of reader.schemasById.values()) topics.addSchema(schema);
    for (const channel of reader.channelsById.values()) topics.addChannel(channel);
    for await (const message of reader.readMessages({ validateCrcs: true })) topics.addMessage(message);
    const metadata = {};
    for await (const record of reader.readMetadata()) metadata[record.name] = Object.fromEntries(record.metadata);
    return { topics: topics.topics, metadata, statistics: reader.statistics, chunks: reader.chunkIndexes.length, library: reader.header.library };
  } finally {
    await handle.close();
  }
}

async function readFrontToBack(file, problems) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(await readFile(file));
  const topics = new Topics(problems);
  const result = { topics: topics.topics, metadata: {}, chunks: 0, library: undefined };
  for (let record; (record = reader.nextRecord()) !== undefined;) {
    if (record.type === "Header") result.library = record.library;
    else if (record.type === "Schema") topics.addSchema(record);
    else if (record.type === "Channel") topics.addChannel(record);
    else if (record.type === "Message") topics.addMessage(record);
    else if (record.type === "Metadata") result.metadata[record.name] = Object.fromEntries(record.metadata);
    else if (record.type === "ChunkIndex") ++result.chunks;
  }
  return { ...result, complete: reader.done() };
}

function countMessages(topics) {
  return Object.values(topics).reduce((sum, topic) => sum + topic.messages, 0);
}

function compare(what, indexed, streamed, problems) {
  const sorted = (object) => JSON.stringify(object, (_, v) => (v && typeof v === "object" && !Array.isArray(v) ? Object.fromEntries(Object.entries(v).sort()) : v));
  if (sorted(indexed) !== sorted(streamed)) problems.push(`index and data section disagree about ${what}`);
}

function compareStatistics(statistics, streamed, problems) {
  const expected = { messageCount: countMessages(streamed.topics), channelCount: Object.keys(streamed.topics).length, chunkCount: streamed.chunks, metadataCount: Object.keys(streamed.metadata).length };
  for (const [name, count] of Object.entries(expected)) {
    if (Number(statistics?.[name]) !== count) problems.push(`statistics: ${name} is ${statistics?.[name]}, there are ${count}`);
  }
}

async function summarise(file, partial) {
  const problems = [];
  const streamed = await readFrontToBack(file, problems);
  if (!partial) {
    const indexed = await readThroughIndex(file, problems);
    compare("topics", indexed.topics, streamed.topics, problems);
    compare("metadata", indexed.metadata, streamed.metadata, problems);
    compareStatistics(indexed.statistics, streamed, problems);
    if (!streamed.complete) problems.push("the file does not end as an MCAP file does");
    if (!streamed.metadata["tether.end"]) problems.push('no metadata "tether.end"');
  }
  if (!streamed.metadata.tether) problems.push('no metadata "tether"');
  return { file, ...streamed, messages: countMessages(streamed.topics), problems };
}

const args = process.argv.slice(2);
const partial = args[0] === "--partial";
const files = partial ? args.slice(1) : args;
if (files.length !== 1 || files[0].startsWith("--")) {
  console.error("usage: node read_mcap.mjs [--partial] RECORD");
  process.exit(2);
}
try {
  const summary = await summarise(files[0], partial);
  console.log(JSON.stringify(summary, null, 2));
  process.exitCode = summary.problems.length === 0 ? 0 : 1;
} catch (error) {
  console.log(JSON.stringify({ file: files[0], problems: [String(error)] }, null, 2));
  process.exitCode = 1;
}
