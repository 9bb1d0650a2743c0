// Recordings of packets give what decode_lidar makes of the same packets' capture. The programs are those that are
// built; captures are written here, and, where they are at hand, of real sensors.

import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";
import { LogWriter, readLog } from "../lib/lcm_log.mjs";
import { voqcalTypes } from "../lib/lcm_types.mjs";
import { programPath } from "../lib/program_path.mjs";
import { openRecording } from "../lib/recordings/open.mjs";
import { writeDb3, writeMcap } from "./recording_writers.mjs";

const folder = mkdtempSync(join(tmpdir(), "voqcal-packets-"));
after(() => rmSync(folder, { recursive: true }));
const path = (name) => join(folder, name);
const importRos = fileURLToPath(new URL("../../import_ros", import.meta.url));
const realData = fileURLToPath(new URL("../../../../shared/data/packets/", import.meta.url));
const types = voqcalTypes();

const isBuilt = programPath("decode_packets") && programPath("decode_lidar");
const options = { skip: !isBuilt && "the programs are not built" };

// ---- Captures: {timeUs, bytes} of each packet ------------------------------------------------------

const START_US = 1_600_000_000_000_000n;

/** Two and a half turns of a VLP-16 whose walls are 5 m away, but for the first blocks of a turn. */
function vlp16Packets() {
  return Array.from({ length: 190 }, (_, i) => {
    const bytes = Buffer.alloc(1206);
    for (let block = 0; block < 12; ++block) {
      const azimuth = (40 * (12 * i + block)) % 36000;
      bytes.writeUInt16LE(0xeeff, 100 * block);
      bytes.writeUInt16LE(azimuth, 100 * block + 2);
      for (let place = 0; place < 32; ++place) {
        bytes.writeUInt16LE(azimuth < 400 ? 0 : 2500 + place, 100 * block + 4 + 3 * place);
        bytes[100 * block + 6 + 3 * place] = place;
      }
    }
    bytes.writeUInt32LE(1327 * i, 1200);
    bytes[1204] = 0x37;
    bytes[1205] = 0x22;
    return { timeUs: START_US + BigInt(1327 * i), bytes };
  });
}

/** By RoboSense's manuals: 130 data packets, a block every 0.4 degrees, walls 5 m away. RS-LiDAR-16 and -32 look alike. */
function robosensePackets() {
  return Array.from({ length: 130 }, (_, i) => {
    const bytes = Buffer.alloc(1248);
    bytes.write("55aa050a5aa550a0", "hex");
    const us = 1200 * i;
    Buffer.from([20, 9, 13, 12, 26, 40, Math.floor(us / 1000) >> 8, Math.floor(us / 1000) & 255, (us % 1000) >> 8, us % 1000 & 255]).copy(bytes, 20);
    for (let block = 0; block < 12; ++block) {
      const at = 42 + 100 * block;
      bytes.writeUInt16BE(0xffee, at);
      bytes.writeUInt16BE((40 * (12 * i + block)) % 36000, at + 2);
      for (let channel = 0; channel < 32; ++channel) {
        bytes.writeUInt16BE(1000 + channel, at + 4 + 3 * channel);
        bytes[at + 6 + 3 * channel] = channel;
      }
    }
    return { timeUs: START_US + BigInt(us), bytes };
  });
}

/** What the sensor says of itself (DIFOP): the strongest return; 32 lasers from `lowest` (1/100 degree) on, each 0.5 higher. */
function robosenseState(lowest = -1000) {
  const bytes = Buffer.alloc(1248);
  bytes.write("a5ff005a11115555", "hex");
  bytes[300] = 1;
  for (let laser = 0; laser < 32; ++laser) {
    const elevation = lowest + 50 * laser;
    bytes[468 + 3 * laser] = Number(elevation < 0);
    bytes.writeUInt16BE(Math.abs(elevation), 469 + 3 * laser);
  }
  return { timeUs: START_US - 1000n, bytes };
}

function readPcap(file) {
  const all = readFileSync(file);
  const packets = [];
  for (let at = 24; at < all.length; ) {
    const numBytes = all.readUInt32LE(at + 8);
    const timeUs = BigInt(all.readUInt32LE(at)) * 1_000_000n + BigInt(all.readUInt32LE(at + 4));
    packets.push({ timeUs, bytes: all.subarray(at + 16 + 42, at + 16 + numBytes) });
    at += 16 + numBytes;
  }
  return packets;
}

function writePcap(file, packets) {
  const frames = packets.flatMap(({ timeUs, bytes }) => {
    const head = Buffer.alloc(16 + 42);
    head.writeUInt32LE(Number(timeUs / 1_000_000n), 0);
    head.writeUInt32LE(Number(timeUs % 1_000_000n), 4);
    head.writeUInt32LE(42 + bytes.length, 8);
    head.writeUInt32LE(42 + bytes.length, 12);
    head.writeUInt16BE(0x0800, 16 + 12);
    head.writeUInt8(0x45, 16 + 14);
    head.writeUInt16BE(28 + bytes.length, 16 + 16);
    head.writeUInt8(17, 16 + 23);
    head.writeUInt16BE(2368, 16 + 36);
    head.writeUInt16BE(8 + bytes.length, 16 + 38);
    return [head, bytes];
  });
  const fileHead = Buffer.from("d4c3b2a1" + "0200" + "0400" + "00000000".repeat(2) + "ffff0000" + "01000000", "hex");
  writeFileSync(file, Buffer.concat([fileHead, ...frames]));
}

// ---- Recordings of them ------------------------------------------------------------------------------

const stampOf = (timeUs) => ({ sec: Number(timeUs / 1_000_000n), nsec: 1000 * Number(timeUs % 1_000_000n) });
const headerAt = (timeUs) => ({ seq: 0, stamp: stampOf(timeUs), frame_id: "lidar" });
const padded = (bytes, length) => Buffer.concat([bytes, Buffer.alloc(length - bytes.length)]);

/** By type, what a driver makes of the packets of 0.1 s. */
const SCANS = {
  "velodyne_msgs/VelodyneScan": ({ timeUs, bytes }) => ({ stamp: stampOf(timeUs), data: bytes }),
  "pandar_msgs/PandarScan": ({ timeUs, bytes }) => ({ stamp: stampOf(timeUs), data: padded(bytes, 1500), size: bytes.length }),
  "nebula_msgs/NebulaPackets": ({ timeUs, bytes }) => ({ stamp: stampOf(timeUs), data: bytes }),
  "hesai_ros_driver/UdpFrame": ({ bytes }) => ({ data: bytes, size: bytes.length }),
  "robosense_msgs/RobosenseScan": ({ timeUs, bytes }) => ({ stamp: stampOf(timeUs), data: bytes, size: bytes.length }),
  "rslidar_msgs/rslidarScan": ({ timeUs, bytes }) => ({ stamp: stampOf(timeUs), data: bytes }),
};

function scansOf(packets, type) {
  const scans = [];
  for (let i = 0; i < packets.length; i += 70) {
    const part = packets.slice(i, i + 70);
    const logTimeNs = 1000n * part.at(-1).timeUs + 5_000_000n;
    const message = { header: headerAt(part[0].timeUs), packets: part.map(SCANS[type]) };
    scans.push({ topic: "/packets", type, logTimeNs, message });
  }
  return scans;
}

const singles = (packets) =>
  packets.map(({ timeUs, bytes }) => ({
    topic: "/packets",
    type: "ouster_sensor_msgs/PacketMsg",
    logTimeNs: 1000n * timeUs,
    message: { buf: bytes },
  }));

/** Messages of one packet each, as RoboSense's drivers record the sensor's state, and the newer one all packets. */
const RS_SINGLES = {
  "rslidar_msgs/rslidarPacket": ({ timeUs, bytes }) => ({ stamp: stampOf(timeUs), data: bytes }),
  "rslidar_msg/RslidarPacket": ({ timeUs, bytes }) => ({ header: headerAt(timeUs), is_difop: bytes[0] === 0xa5, is_frame_begin: 0, data: bytes }),
};
const rsSingles = (packets, type, topic) =>
  packets.map((packet) => ({ topic, type, logTimeNs: 1000n * packet.timeUs, message: RS_SINGLES[type](packet) }));

const image = (timeNs) => ({
  topic: "/camera",
  type: "sensor_msgs/Image",
  logTimeNs: timeNs,
  message: { header: headerAt(timeNs / 1000n), width: 2, height: 1, encoding: "mono8", is_bigendian: 0, step: 2, data: Buffer.alloc(2) },
});
const withImages = (scans) => scans.flatMap((scan) => [scan, image(scan.logTimeNs)]);

// ---- What comes of them --------------------------------------------------------------------------------

const POINT_BYTES = 22;

/** {utime, points} of each sweep; a point's bytes: x y z intensity ring time. */
function imported(file, ...flags) {
  const out = execFileSync(importRos, [file, "--force", "--out", path("out.lcm"), ...flags], { encoding: "utf8" });
  return { sweeps: sweepsOf(path("out.lcm")), out };
}

function sweepsOf(log, wanted = "LIDAR_POINTS") {
  const clouds = [...readLog(log)].filter(({ channel }) => channel === wanted);
  return clouds.map(({ bytes }) => {
    const { utime, width, point_step: step, fields, data } = types.decode("pointcloud2_t", bytes);
    const parts = ["x", "y", "z", "intensity", "ring", "time"].map((name) => fields.find((field) => field.name === name));
    const points = Buffer.alloc(POINT_BYTES * width);
    for (let i = 0, to = 0; i < width; ++i) {
      for (const { offset, datatype } of parts) to += data.copy(points, to, i * step + offset, i * step + offset + (datatype === 4 ? 2 : 4));
    }
    return { utime, points };
  });
}

/** The same of decode_lidar, told to do as a rig does that says nothing. */
function decoded(capture, model, splitAzimuth = "180", ...flags) {
  const out = path("sweeps");
  const asRigs = ["--returns", "strongest", "--split-azimuth", splitAzimuth, ...flags];
  execFileSync(programPath("decode_lidar"), [capture, "--model", model, "--out", out, ...asRigs]);
  return readdirSync(out).sort().map((name) => {
    const bytes = readFileSync(join(out, name));
    const begin = bytes.indexOf("DATA binary\n") + 12;
    const numPoints = (bytes.length - begin) / (POINT_BYTES + 1); // the number of the return is last
    const points = Buffer.alloc(POINT_BYTES * numPoints);
    for (let i = 0; i < numPoints; ++i) {
      const at = begin + i * (POINT_BYTES + 1);
      bytes.copy(points, i * POINT_BYTES, at, at + POINT_BYTES);
    }
    return { utime: BigInt(/# utime (\d+)/.exec(bytes.toString("latin1", 0, 100))[1]), points };
  });
}

const pointsOf = (sweeps) => sweeps.map(({ points }) => points);

test("VelodyneScan in MCAP and sqlite3, which does not define it: as decode_lidar", options, async () => {
  const packets = vlp16Packets();
  writePcap(path("a.pcap"), packets);
  const expected = decoded(path("a.pcap"), "velodyne_vlp16");
  assert.ok(expected.length >= 3);
  const scans = withImages(scansOf(packets, "velodyne_msgs/VelodyneScan"));
  await writeMcap(path("a.mcap"), scans);
  const { sweeps, out } = imported(path("a.mcap"));
  assert.deepEqual(sweeps, expected);
  assert.match(out, /LIDAR_POINTS: \d sweeps of packets of a Velodyne VLP-16[^:]*: 190 packets/);
  writeDb3(path("a.db3"), scans);
  assert.deepEqual(imported(path("a.db3")).sweeps, expected);
});

test("packets one by one and without times: the log's", options, async () => {
  const packets = vlp16Packets();
  await writeMcap(path("b.mcap"), withImages(singles(packets)));
  assert.deepEqual(imported(path("b.mcap")).sweeps, decoded(path("a.pcap"), "velodyne_vlp16"));
});

test("an LCM log of raw_t, as the lidar driver publishes packets: as decode_lidar", options, () => {
  const log = new LogWriter(path("raw.lcm"));
  const packets = vlp16Packets();
  for (const { timeUs, bytes } of packets) {
    log.write(timeUs, "LIDAR_PACKETS", types.encode("raw_t", { utime: timeUs, length: bytes.length, data: bytes }));
  }
  const eye = { utime: packets.at(-1).timeUs, width: 2, height: 1, row_stride: 2, pixelformat: 1497715271, size: 2, data: Buffer.alloc(2), nmetadata: 0, metadata: [] };
  log.write(eye.utime, "CAMERA_IMAGE", types.encode("image_t", eye));
  log.finish();
  assert.deepEqual(imported(path("raw.lcm")).sweeps, decoded(path("a.pcap"), "velodyne_vlp16"));
});

test("stamps of another clock: log times, said; forbidden if asked", options, async () => {
  const late = vlp16Packets().map(({ timeUs, bytes }) => ({ timeUs: timeUs - START_US + 7_000_000n, bytes }));
  const scans = scansOf(late, "velodyne_msgs/VelodyneScan").map((scan) => ({ ...scan, logTimeNs: scan.logTimeNs + 1000n * START_US }));
  await writeMcap(path("c.mcap"), withImages(scans));
  const { sweeps, out } = imported(path("c.mcap"));
  assert.match(out, /the clocks of lidar and camera differ by 50.7 years; log times agree within 0 ms: using them/);
  assert.ok(sweeps[0].utime > START_US && sweeps[0].utime < START_US + 10_000_000n);
  assert.ok(imported(path("c.mcap"), "--times", "stamps").sweeps[0].utime < 20_000_000n);
});

test("sweeps end where the rig file says", options, async () => {
  const rigs = new URL("../../../config/rigs/simulated_vlp16.yaml", import.meta.url);
  const text = readFileSync(rigs, "utf8");
  const asSensor = text.replace("source: simulator", "source: velodyne_vlp16\n  sensor: {split_azimuth_deg: 90}");
  writeFileSync(path("rig.yaml"), asSensor);
  await writeMcap(path("e.mcap"), withImages(scansOf(vlp16Packets(), "velodyne_msgs/VelodyneScan")));
  const { sweeps } = imported(path("e.mcap"), "--rig", path("rig.yaml"));
  assert.deepEqual(sweeps, decoded(path("a.pcap"), "velodyne_vlp16", "90"));
});

test("of a rig's lidars each is decoded as its own section says", options, async () => {
  const rig = `rig: truck
board: {width_m: 0.6, height_m: 0.8, square_m: 0.1, num_corners_x: 5, num_corners_y: 7}
lidars:
  front: {lidar_driver: {source: velodyne_vlp16}}
  rear: {lidar_driver: {source: velodyne_vlp16, sensor: {split_azimuth_deg: 90}}}
cameras:
  left:
    camera: {lens_model: plumb_bob, width_px: 2, height_px: 1, fx_px: 2, fy_px: 2, cx_px: 1, cy_px: 0.5, distortion: [0, 0, 0, 0, 0]}
`;
  writeFileSync(path("truck.yaml"), rig);
  const scans = scansOf(vlp16Packets(), "velodyne_msgs/VelodyneScan");
  const on = (topic) => scans.map((scan) => ({ ...scan, topic }));
  await writeMcap(path("truck.mcap"), withImages([...on("/rear/packets"), ...on("/front/packets")]));
  const sensors = ["--lidar", "front=FRONT", "--lidar", "rear=REAR", "--camera", "left=LEFT"];
  imported(path("truck.mcap"), "--rig", path("truck.yaml"), ...sensors);
  assert.deepEqual(sweepsOf(path("out.lcm"), "FRONT"), decoded(path("a.pcap"), "velodyne_vlp16"));
  assert.deepEqual(sweepsOf(path("out.lcm"), "REAR"), decoded(path("a.pcap"), "velodyne_vlp16", "90"));
});

for (const type of ["robosense_msgs/RobosenseScan", "rslidar_msgs/rslidarScan"]) {
  test(`RoboSense's scans as ${type}: as decode_lidar`, options, async () => {
    const packets = robosensePackets();
    writePcap(path("rs.pcap"), packets);
    const expected = decoded(path("rs.pcap"), "robosense_16");
    assert.ok(expected.length >= 2 && pointsOf(expected).every((points) => points.length > 0));
    await writeMcap(path("rs.mcap"), withImages(scansOf(packets, type)));
    const model = ["--lidar-model", "robosense_16"]; // its packets are those of others too
    assert.deepEqual(pointsOf(imported(path("rs.mcap"), ...model).sweeps), pointsOf(expected));
    const database = path(`${type.split("/")[1]}.db3`);
    writeDb3(database, withImages(scansOf(packets, type)));
    assert.deepEqual(pointsOf(imported(database, ...model).sweeps), pointsOf(expected));
  });
}

test("RoboSense's angles come from the topic of the sensor's state", options, async () => {
  const packets = robosensePackets();
  writePcap(path("rs32.pcap"), [robosenseState(), ...packets]);
  const expected = pointsOf(decoded(path("rs32.pcap"), "robosense_32"));
  assert.ok(expected.length >= 2 && expected.every((points) => points.length > 0));
  const model = ["--lidar-model", "robosense_32"];
  const scans = withImages(scansOf(packets, "rslidar_msgs/rslidarScan"));
  const state = rsSingles([robosenseState()], "rslidar_msgs/rslidarPacket", "/rslidar_packets_difop");
  await writeMcap(path("rs32.mcap"), [...state, ...scans]);
  assert.deepEqual(pointsOf(imported(path("rs32.mcap"), ...model).sweeps), expected);
});

test("of several RoboSense each has the angles of its own state's topic; where names do not tell, --topic does", options, async () => {
  const packets = robosensePackets();
  const states = { front: robosenseState(-1000), rear: robosenseState(-500) };
  const expected = {};
  for (const [name, state] of Object.entries(states)) {
    writePcap(path(`${name}.pcap`), [state, ...packets]);
    expected[name] = pointsOf(decoded(path(`${name}.pcap`), "robosense_32"));
  }
  assert.notDeepEqual(expected.front, expected.rear);
  const scans = scansOf(packets, "rslidar_msgs/rslidarScan");
  const write = async (file, topics, difops) => {
    const all = Object.keys(states).map((name, i) => rsSingles([states[name]], "rslidar_msgs/rslidarPacket", difops[i]));
    const sent = topics.flatMap((topic) => scans.map((scan) => ({ ...scan, topic })));
    await writeMcap(path(file), [...all.flat(), ...withImages(sent)]);
  };
  const sensors = ["--lidar", "front=FRONT", "--lidar", "rear=REAR", "--camera", "left=LEFT", "--lidar-model", "robosense_32"];
  const bothRight = (file, ...flags) => {
    imported(path(file), ...sensors, ...flags);
    assert.deepEqual(pointsOf(sweepsOf(path("out.lcm"), "FRONT")), expected.front);
    assert.deepEqual(pointsOf(sweepsOf(path("out.lcm"), "REAR")), expected.rear);
  };
  const inOneFolder = ["/rslidar/front_packets", "/rslidar/rear_packets"];
  await write("two.mcap", inOneFolder, ["/rslidar/front_difop", "/rslidar/rear_difop"]);
  bothRight("two.mcap");
  // Of one that is taken, not the other's.
  imported(path("two.mcap"), "--lidar-topic", "/rslidar/front_packets", "--lidar-model", "robosense_32");
  assert.deepEqual(pointsOf(sweepsOf(path("out.lcm"))), expected.front);
  await write("two.mcap", ["/lidar1", "/lidar10"], ["/lidar1_difop", "/lidar10_difop"]);
  bothRight("two.mcap", "--topic", "front=/lidar1", "--topic", "rear=/lidar10");
  await write("two.mcap", inOneFolder, ["/rslidar/difop_0", "/rslidar/difop_1"]);
  const unclear = spawnSync(importRos, [path("two.mcap"), "--force", "--out", path("out.lcm"), ...sensors], { encoding: "utf8" });
  assert.equal(unclear.status, 1);
  assert.match(unclear.stderr, /^import_ros: [^\n]*: which lidar's \/rslidar\/difop_0 is, that of [^\n]*: --topic SENSOR=\/rslidar\/difop_0 says it[^\n]*\n$/);
  bothRight("two.mcap", "--topic", "front=/rslidar/difop_0", "--topic", "rear=/rslidar/difop_1");
});

test("RoboSense's packets one by one, the sensor's state among them: as decode_lidar", options, async () => {
  const packets = [robosenseState(), ...robosensePackets()];
  const singles = rsSingles(packets, "rslidar_msg/RslidarPacket", "/rslidar_packets");
  await writeMcap(path("rs32s.mcap"), withImages(singles));
  const { sweeps } = imported(path("rs32s.mcap"), "--lidar-model", "robosense_32");
  assert.deepEqual(pointsOf(sweeps), pointsOf(decoded(path("rs32.pcap"), "robosense_32")));
});

test("packets that cannot be decoded: one line, and no log", options, async () => {
  const run = (...flags) => spawnSync(importRos, [path("d.mcap"), "--out", path("d.lcm"), ...flags], { encoding: "utf8" });
  const refuses = (done, words) => {
    assert.equal(done.status, 1);
    assert.match(done.stderr, words);
    assert.ok(!existsSync(path("d.lcm")));
  };
  await writeMcap(path("d.mcap"), withImages(scansOf(vlp16Packets(), "velodyne_msgs/VelodyneScan")));
  refuses(run("--lidar-model", "hesai_40p"), /^import_ros: [^\n]*no Pandar40P packet among 190 of 1206 bytes: another sensor\?[^\n]*\n$/);
  refuses(run("--lidar-model", "vlp17"), /--lidar-model must be one of velodyne_vlp16/);
  const alien = vlp16Packets().map((packet) => ({ ...packet, bytes: Buffer.alloc(1206) }));
  await writeMcap(path("d.mcap"), withImages(scansOf(alien, "velodyne_msgs/VelodyneScan")));
  refuses(run(), /whose packets these are is not recognised \(190, the last of 1206 bytes\): --lidar-model names the lidar/);
});

const REAL = {
  velodyne_vlp16: "velodyne_msgs/VelodyneScan",
  velodyne_vlp32: "nebula_msgs/NebulaPackets",
  hesai_40p: "pandar_msgs/PandarScan",
  hesai_xt16: "hesai_ros_driver/UdpFrame",
};
for (const [model, type] of Object.entries(REAL)) {
  const capture = join(realData, "nebula", `${model}.pcap`);
  test(`a real ${model} as ${type}: as decode_lidar`, { skip: options.skip || !existsSync(capture) }, async () => {
    await writeMcap(path("real.mcap"), withImages(scansOf(readPcap(capture), type)));
    const { sweeps } = imported(path("real.mcap"));
    const expected = decoded(capture, model);
    assert.ok(expected.length > 0);
    assert.deepEqual(pointsOf(sweeps), pointsOf(expected));
  });
}

const ousterBag = join(realData, "ouster/bags/512x10_raw.bag");
test("a real Ouster's bag with its metadata: as decode_lidar", { skip: options.skip || !existsSync(ousterBag) }, async () => {
  const recording = await openRecording([ousterBag], folder);
  const packets = [];
  for await (const { topic, logTimeNs, decode } of recording.messages(["/os_node0/lidar_packets", "/os_node0/metadata"])) {
    if (topic.endsWith("metadata")) writeFileSync(path("metadata.json"), decode().data);
    else packets.push({ timeUs: logTimeNs / 1000n, bytes: Buffer.from(decode().buf) });
  }
  await recording.close();
  writePcap(path("ouster.pcap"), packets);
  await writeMcap(path("images.mcap"), [image(1000n * packets.at(-1).timeUs)]);
  execFileSync(importRos, [ousterBag, path("images.mcap"), "--force", "--out", path("out.lcm")]);
  const expected = decoded(path("ouster.pcap"), "ouster", "180", "--calibration", path("metadata.json"));
  assert.ok(expected.length > 0);
  assert.deepEqual(sweepsOf(path("out.lcm")), expected);
});
