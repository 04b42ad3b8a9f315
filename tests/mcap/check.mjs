// SPDX-License-Identifier: Apache-2.0
// MCAP logs as @mcap/core reads them: numbers are those of the CSV log, bit for bit; poses of links
// are those that another kinematics gives; messages have the fields of foxglove's schemas.
//
//   node check.mjs FOLDER NAME=URDF…

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import { difference, linkPoses, readLog, readUrdf } from '../browser/kinematics.mjs';

const [folder, ...runs] = process.argv.slice(2);
const require = createRequire(resolve(folder, 'check.cjs'));
const { McapIndexedReader, McapStreamReader } = require('@mcap/core');
const published = require('@foxglove/schemas/jsonschema');

/** Where a message is not as its schema has it; `strict`: nor may it have other members. */
function complaints(schema, value, strict, path = '') {
  const { type, required = [], properties = {}, items, oneOf } = schema;
  const is = Array.isArray(value) ? 'array' : typeof value;
  if (oneOf) return oneOf.some((one) => one.const === value) ? [] : [`${path}: ${value}`];
  if (type === 'integer' ? !Number.isInteger(value) : type && is !== type) return [`${path}: ${is}, not ${type}`];
  if (is === 'array') return value.flatMap((item, i) => complaints(items, item, strict, `${path}[${i}]`));
  if (is !== 'object') return [];
  return [
    ...required.filter((name) => !(name in value)).map((name) => `${path}.${name} is missing`),
    ...Object.entries(value).flatMap(([name, member]) =>
      properties[name]
        ? complaints(properties[name], member, strict, `${path}.${name}`)
        : strict
          ? [`${path}.${name} is not in the schema`]
          : [],
    ),
  ];
}

/** The file read by its index: messages of every topic in the order of time. */
async function readIndexed(bytes) {
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, length) => bytes.subarray(Number(offset), Number(offset + length)),
  };
  const reader = await McapIndexedReader.Initialize({ readable });
  const topics = {};
  let count = 0n;
  for await (const { channelId, data, logTime, sequence } of reader.readMessages()) {
    const { topic, schemaId } = reader.channelsById.get(channelId);
    const known = (topics[topic] ??= { schema: reader.schemasById.get(schemaId), messages: [] });
    assert.equal(sequence, known.messages.length, topic);
    known.messages.push({ time: logTime, message: JSON.parse(Buffer.from(data).toString()) });
    count += 1n;
  }
  assert.equal(reader.statistics.messageCount, count);
  assert.equal(reader.statistics.chunkCount, reader.chunkIndexes.length);
  return topics;
}

/** The file read from its beginning on, checksums checked, has as many messages. */
function countStreamed(bytes) {
  const reader = new McapStreamReader({ validateCrcs: true });
  reader.append(bytes);
  let count = 0;
  for (let record = reader.nextRecord(); record; record = reader.nextRecord())
    count += record.type === 'Message';
  assert.ok(reader.done());
  return count;
}

function checkSchemas(topics) {
  for (const [topic, { schema, messages }] of Object.entries(topics)) {
    assert.equal(schema.encoding, 'jsonschema');
    const own = JSON.parse(Buffer.from(schema.data).toString());
    assert.equal(own.title, schema.name);
    const [, foxglove] = schema.name.match(/^foxglove\.(.*)/) ?? [];
    for (const { message } of messages) {
      assert.deepEqual(complaints(own, message, true, topic), []);
      if (foxglove) assert.deepEqual(complaints(published[foxglove], message, true, topic), []);
    }
  }
}

/** Fields that the CSV log has too; those without a value are left out in both. */
const columns = {
  '/joints': ({ joints }) =>
    joints.flatMap(({ name, ...rest }) =>
      Object.entries({ q: 'position', v: 'velocity', a: 'acceleration', u: 'effort' }).map(
        ([prefix, member]) => [`${prefix}:${name}`, rest[member]],
      ),
    ),
  '/bases': ({ timestamp, ...bases }) =>
    Object.entries(bases).flatMap(([name, parts]) =>
      Object.entries(parts).map(([part, x]) => [`v:${name}.${part}`, x]),
    ),
  '/step': ({ timestamp, forward_us, gdd_us, step_us, ...rest }) => Object.entries(rest),
  '/balance': ({ timestamp, ...rest }) =>
    Object.entries(rest).flatMap(([name, parts]) =>
      Object.entries(parts).map(([part, x]) => [`${name}.${part}`, x]),
    ),
  '/goal_errors': ({ timestamp, ...rest }) => Object.entries(rest).map(([name, x]) => [`error:${name}`, x]),
  '/contact_forces': ({ timestamp, ...links }) =>
    Object.entries(links).flatMap(([name, parts]) =>
      Object.entries(parts).map(([part, x]) => [`f:${name}.${part}`, x]),
    ),
};

function checkNumbers(topics, rows) {
  let compared = 0;
  for (const [topic, columnsOf] of Object.entries(columns))
    (topics[topic]?.messages ?? []).forEach(({ time, message }, i) => {
      assert.equal(Number(time), Math.round(1e9 * rows[i].get('time_s')));
      assert.equal(BigInt(message.timestamp.sec) * 1000000000n + BigInt(message.timestamp.nsec), time);
      for (const [column, x] of columnsOf(message)) {
        if (x === undefined) continue;  // of the last row
        assert.ok(rows[i].has(column), column);
        assert.equal(x, rows[i].get(column), `${column} at ${time} ns`);
        ++compared;
      }
    });
  return compared;
}

function checkPoses(topics, rows, urdf) {
  const messages = topics['/tf'].messages;
  assert.equal(messages.length, rows.length);
  messages.forEach(({ message }, i) => {
    const poses = linkPoses(urdf, rows[i]);
    for (const { child_frame_id: link, parent_frame_id, translation, rotation } of message.transforms) {
      assert.equal(parent_frame_id, 'world');
      const { metres, turn } = difference(
        {
          position: [translation.x, translation.y, translation.z],
          quaternion: [rotation.w, rotation.x, rotation.y, rotation.z],
        },
        poses.get(link),
      );
      assert.ok(metres < 1e-12 && turn < 1e-12, `${link}: ${metres} m, ${turn}`);
    }
  });
  const told = new Set(messages.flatMap(({ message }) => message.transforms.map((t) => t.child_frame_id)));
  const drawn = topics['/shapes'].messages[0].message.entities.map(({ frame_id }) => frame_id);
  for (const link of drawn) assert.ok(told.has(link), `${link} is drawn in a frame that is told`);
  assert.ok(drawn.length > 3);
}

/** The arrows of a step point as the forces do that the links feel from the world. */
function checkArrows(topics, rows) {
  let compared = 0;
  topics['/contacts'].messages.forEach(({ message }, i) => {
    const up = message.entities[0].arrows.map(({ pose, shaft_length, head_length }) => {
      const { x, y } = pose.orientation;
      const { z, w } = pose.orientation;
      return (2 * (x * z - w * y)) * (shaft_length + head_length);
    });
    const forces = [...rows[i]].filter(([name]) => /^f:.*\.z$/.test(name)).map(([, f]) => f);
    const sum = (list) => list.reduce((all, one) => all + one, 0);
    if (sum(forces) < 100) return;
    compared += 1;
    checkArrows.scale ??= sum(up) / sum(forces);
    assert.ok(Math.abs(sum(up) / sum(forces) / checkArrows.scale - 1) < 1e-9);
  });
  return compared;
}

for (const run of runs) {
  const [name, file] = run.split('=');
  const bytes = readFileSync(join(folder, `${name}.mcap`));
  const rows = readLog(join(folder, `${name}.csv`));
  const topics = await readIndexed(bytes);
  const total = Object.values(topics).reduce((sum, { messages }) => sum + messages.length, 0);
  assert.equal(countStreamed(bytes), total);
  checkSchemas(topics);
  const compared = checkNumbers(topics, rows);
  assert.ok(compared > 20 * rows.length, `${compared} numbers`);
  checkPoses(topics, rows, readUrdf(file));
  if (name === 'humanoid') assert.ok(checkArrows(topics, rows) > 100);
  console.log(`${name}: ${total} messages, ${compared} numbers as in the CSV log`);
}
