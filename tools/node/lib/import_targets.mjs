// What becomes of a topic's messages: one target a topic, with
//   channel, rosType, tally
//   prepare    a decoded message made fit to be looked at; throws what is wrong with it
//   stampNs    of what was prepared; where it has none, when it was recorded
//   isTelling  whether what was prepared, one of a recording's first, tells how all are to be encoded
//   encode     async: what was prepared as LCM messages, none or many, encoded
//   finish     async: those that are left at the end, and a line of words or nothing

import { voqcalTypes } from "./lcm_types.mjs";
import { PacketDecoder } from "./packet_decoder.mjs";
import { cameraToLcm, isRectifiedTopic } from "./sensor_msgs/cameras.mjs";
import { asCloud, cloudToLcm } from "./sensor_msgs/clouds.mjs";
import { hasWideNumbers, imageToLcm } from "./sensor_msgs/images.mjs";
import { stampOf } from "./sensor_msgs/messages.mjs";
import { arrivalTimesNs, packetsOf } from "./sensor_msgs/packets.mjs";
import { Tally } from "./tally.mjs";

const types = voqcalTypes();

/** One message in, one out. `toLcm` takes what was prepared, utime, number and what was told of its topic. */
function oneToOne(topic, rosType, channel, type, prepare, isTelling, toLcm) {
  const tally = new Tally(`topic ${topic}`);
  return {
    channel,
    rosType,
    tally,
    prepare: (message) => prepare(message, rosType),
    stampNs: stampOf,
    isTelling,
    async encode(message, logTimeNs, useLogTimes, told) {
      const timeNs = useLogTimes ? logTimeNs : stampOf(message);
      return [types.encodeParts(type, toLcm(message, timeNs / 1000n, tally.numTaken, told))]; // LCM knows no finer
    },
    finish: async () => ({ encoded: [] }),
  };
}

const asItIs = (message) => message;
const always = () => true;
const never = () => false;

export const cloudTarget = (topic, rosType, channel) =>
  oneToOne(topic, rosType, channel, "pointcloud2_t", asCloud, always, cloudToLcm);

export const imageTarget = (topic, rosType, channel) =>
  oneToOne(topic, rosType, channel, "image_t", asItIs, hasWideNumbers, imageToLcm);

export function cameraTarget(topic, rosType, channel, imageTopic) {
  const toLcm = (message, utime, seq) => cameraToLcm(message, utime, seq, isRectifiedTopic(imageTopic));
  return oneToOne(topic, rosType, channel, "camera_info_t", asItIs, never, toLcm);
}

/** A lidar's packets: sweeps come out of them when they are complete. @param decoderArgs  of decode_packets. */
export function packetTarget(topic, rosType, channel, decoderArgs) {
  const decoder = new PacketDecoder(decoderArgs);
  let numSweeps = 0;
  const counted = (clouds) => {
    numSweeps += clouds.length;
    return clouds;
  };
  return {
    channel,
    rosType,
    tally: new Tally(`topic ${topic}`),
    hasPackets: true,
    prepare: packetsOf,
    stampNs: ({ stampNs }, logTimeNs) => stampNs ?? logTimeNs,
    isTelling: never,
    async encode(message, logTimeNs, useLogTimes) {
      return counted(await decoder.add(message.packets, arrivalTimesNs(message, logTimeNs, useLogTimes)));
    },
    async finish() {
      const { clouds, words } = await decoder.finish();
      const encoded = counted(clouds);
      return { encoded, words: `${numSweeps} sweeps of ${words}` };
    },
    close: () => decoder.close(),
  };
}
