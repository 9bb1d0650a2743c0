// What clocks, times and bits are told by.

const NUM_SAMPLED = 20; // messages of each topic
const MAX_BYTES_A_SENSOR = 1 << 28; // read until then, be it of others: a sensor may be silent

/**
 * The first messages of each sensor: {message, stampNs, logTimeNs} by topic; without the message where nothing in it tells.
 * Broken ones are passed over.
 */
export async function firstMessages(recording, plan, sensors) {
  const first = new Map(sensors.map(({ topic }) => [topic, []]));
  let numBytes = 0;
  for await (const { topic, logTimeNs, data, decode } of recording.messages([...first.keys()])) {
    const { prepare, stampNs, isTelling } = plan.get(topic);
    numBytes += data.length;
    const isEnough = [...first.values()].every(({ length }) => length >= NUM_SAMPLED);
    if (isEnough || numBytes > MAX_BYTES_A_SENSOR * first.size) break;
    if (first.get(topic).length >= NUM_SAMPLED) continue;
    try {
      const message = prepare(decode());
      const told = isTelling(message) ? message : undefined;
      first.get(topic).push({ message: told, logTimeNs, stampNs: stampNs(message, logTimeNs) });
    } catch {
      // Counted when it is imported.
    }
  }
  return first;
}
