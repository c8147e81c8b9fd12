// SPDX-License-Identifier: Apache-2.0
// MCAP files beside an independent reader and writer (@mcap/core).
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

const require = createRequire(join(process.env.KINFER_SOURCE, 'web', 'package.json'));
const { McapIndexedReader, McapWriter, TempBuffer } = require('@mcap/core');
const folder = join(process.env.KINFER_BROWSER_FOLDER, 'mcap');
const kinfer = (...options) => execFileSync(process.env.KINFER_PROGRAM, options, { cwd: folder, encoding: 'utf8' });
const rows = 200;

before(() => {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
});
after(() => rmSync(folder, { recursive: true, force: true }));

const imuDefinition = [
  'std_msgs/Header header', 'geometry_msgs/Quaternion orientation', 'float64[9] orientation_covariance',
  'geometry_msgs/Vector3 angular_velocity', 'float64[9] angular_velocity_covariance',
  'geometry_msgs/Vector3 linear_acceleration', 'float64[9] linear_acceleration_covariance'].join('\n');

/** CDR of sensor_msgs/Imu with the frame "f". */
function imuMessage(nanoseconds, rate, force) {
  const bytes = Buffer.alloc(4 + 16 + 37 * 8);
  bytes.writeUInt8(1, 1);
  bytes.writeInt32LE(Math.floor(nanoseconds / 1e9), 4);
  bytes.writeUInt32LE(nanoseconds % 1e9, 8);
  bytes.writeUInt32LE(2, 12);
  bytes.write('f\0', 16);
  const numbers = [0, 0, 0, 1, ...Array(9).fill(0), ...rate, ...Array(9).fill(0), ...force, ...Array(9).fill(0)];
  numbers.forEach((value, i) => bytes.writeDoubleLE(value, 20 + 8 * i));
  return bytes;
}

async function writeDrive(compressed) {
  const file = new TempBuffer();
  const writer = new McapWriter({ writable: file, useChunks: compressed !== undefined, chunkSize: 4096 });
  await writer.start({ profile: 'ros2', library: 'test' });
  const schemaId = await writer.registerSchema(
    { name: 'sensor_msgs/msg/Imu', encoding: 'ros2msg', data: Buffer.from(imuDefinition) });
  const channels = [];
  for (const topic of ['/boom/imu', '/arm/imu'])
    channels.push(await writer.registerChannel({ topic, schemaId, messageEncoding: 'cdr', metadata: new Map() }));
  for (let row = 0; row < rows; ++row)
    for (const [k, channelId] of channels.entries()) {
      const logTime = BigInt(1_000_000_000 + 10_000_000 * row);
      const data = imuMessage(Number(logTime), [0.01 * row, k, 0], [0, 0, 9.80665]);
      await writer.addMessage({ channelId, sequence: row, logTime, publishTime: logTime, data });
    }
  await writer.end();
  return file.get();
}

test('what an independent writer writes is read', async () => {
  for (const chunks of [undefined, '']) {
    writeFileSync(join(folder, 'drive.mcap'), await writeDrive(chunks));
    const text = kinfer('inspect', 'drive.mcap');
    assert.match(text, /drive\.mcap: 2 topics/);
    assert.match(text, new RegExp(`/boom/imu +sensor_msgs/Imu +${rows} +100 `));
    assert.match(text, /arm: accelerometer 100 Hz, gyroscope 100 Hz/);
  }
});

test('a file that is cut off is read as far as it goes', async () => {
  const whole = await writeDrive(undefined);
  writeFileSync(join(folder, 'cut.mcap'), whole.subarray(0, Math.floor(whole.length / 2)));
  assert.match(kinfer('inspect', 'cut.mcap'), /ends in the middle of a record/);
});

test('an independent reader reads what is written', async () => {
  kinfer('simulate', 'excavator', '--out', 'drive', '--grade', 'noise', '--duration', '20');
  kinfer('convert', 'drive/imu.csv', 'log.mcap');
  const bytes = readFileSync(join(folder, 'log.mcap'));
  const decompress = (await import('node:zlib')).zstdDecompressSync;
  const readable = { size: async () => BigInt(bytes.length),
                     read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)) };
  const decompressHandlers = decompress ? { zstd: (data) => decompress(data) } : {};
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const lines = readFileSync(join(folder, 'drive', 'imu.csv'), 'utf8').trim().split('\n').length - 1;
  const topics = [...reader.channelsById.values()].map((channel) => channel.topic);
  assert.ok(topics.includes('/ins1/imu'), `${topics}`);
  const imus = topics.filter((topic) => topic.endsWith('/imu')).length;
  let counted = 0n;
  for (const channel of reader.channelsById.values())
    if (channel.topic.endsWith('/imu')) counted += reader.statistics.channelMessageCounts.get(channel.id);
  assert.equal(counted, BigInt(imus * lines));
  if (!decompress) return;  // before node 22.15: the chunks themselves cannot be unpacked here
  let messages = 0;
  for await (const message of reader.readMessages()) messages += message.data.length > 0;
  assert.ok(messages >= imus * lines);
});
