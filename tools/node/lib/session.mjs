// A session's samples.lcm: the samples and their scenes. Channels as modules/messaging/session_scenes.hpp
// names them: a sample's sweep and image come before it.

import { UserError } from "./command.mjs";
import { readLog } from "./lcm_log.mjs";
import { voqcalTypes } from "./lcm_types.mjs";

/** Yields {sample, sweep, image} in order; sweep and image are undefined where the session has none. */
export function* readSession(path) {
  const types = voqcalTypes();
  const decode = (type, event) => {
    try {
      return types.decode(type, event.bytes);
    } catch (error) {
      throw new UserError(`${path}: ${event.channel}: ${error.message}`);
    }
  };
  const channels = new Set();
  let scene = {};
  for (const event of readLog(path)) {
    channels.add(event.channel);
    if (event.channel === "CALIB_SWEEP") scene.sweep = decode("pointcloud2_t", event);
    if (event.channel === "CALIB_IMAGE") scene.image = decode("image_t", event);
    if (event.channel !== "CALIB_SAMPLE") continue;
    yield { sample: decode("sample_t", event), ...scene };
    scene = {};
  }
  if (!channels.has("CALIB_SAMPLE")) {
    const there = channels.size === 0 ? "no events" : [...channels].join(", ");
    throw new UserError(`${path}: has no channel CALIB_SAMPLE (a session's samples.lcm has); it has ${there}`);
  }
}
